#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# boxtree_scaling: a row for each mesh and size, with answers, and a page with a plot of each
# query. No time is looked at.
#   scaling_test.sh BOXTREE_SCALING
set -euo pipefail
scaling=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

for codec in wide8 wide4; do
  "$scaling" --quick --json --codec "$codec" --html "$work/$codec.html" >"$work/$codec.json" 2>/dev/null
  [ "$(jq -c '[.rows[] | [.mesh, .triangles]]' "$work/$codec.json")" = \
    '[["terrain",1000],["terrain",10000],["city",1000],["city",10000]]' ] ||
    { echo "unexpected rows"; cat "$work/$codec.json"; exit 1; }
  [ "$(jq '[.rows[] | select(.ray_hits > 0 and .ray_ns > 0 and .pair_hits > 0 and .pair_first_us > 0)] | length' \
    "$work/$codec.json")" -eq 4 ] || { echo "no answers"; cat "$work/$codec.json"; exit 1; }
  [ "$(grep -o '<svg' "$work/$codec.html" | wc -l)" -eq 3 ] || { echo "expected three plots"; exit 1; }
done

# Codecs differ in time, never in answers.
hits() { jq -c '[.rows[] | [.ray_hits, .pair_hits]]' "$1"; }
[ "$(hits "$work/wide8.json")" = "$(hits "$work/wide4.json")" ] || { echo "answers differ"; exit 1; }
