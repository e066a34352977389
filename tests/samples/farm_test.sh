#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The farm of samples/farm: shards and caches give the bytes of one run, and one edit cooks one mesh.
set -euo pipefail
boxtree=$1 farm=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
ln -s "$boxtree" "$work/boxtree"
said=$(PATH=$work:$PATH bash "$farm/farm.sh" 24 3)
for line in 'they wrote the bytes of one run' '24 cooked, 0 from the cache' '0 cooked, 24 from the cache' \
  '1 cooked, 0 from the cache, 23 there already' 'audited and alike' 'assets.bxt: 24 trees of 24 files' \
  '31 tiles, 31 written' '31 tiles, 1 written' 'world.jsonl: 1 cooked, 0 from the cache, 30 there already'; do
  grep -qF "$line" <<<"$said" || { echo "expected '$line' in"; echo "$said"; exit 1; }
done
