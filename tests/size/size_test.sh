#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Sizes of the runtime in linked and stripped programs of few lines, code and data, less those of an
# empty program; left_out_test.sh has those of smaller runtimes. The runtime has no codec of the paper and
# no decompressor of its own.
#   size_test.sh BOXTREE WHOLE RUNTIME EMPTY SHAPES    the last four: programs/ of the build under test
set -euo pipefail
boxtree=$1 whole=$2 runtime=$3 empty=$4 shapes=$5
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "size: $*"; exit 1; }
# shellcheck source=tests/size/measure.sh
. "$(dirname "$0")/measure.sh"
less=$(bytes "$empty")

smaller 'every query but casts and contacts of shapes' "$runtime" $((442 * 1024))
smaller 'every query' "$shapes" $((546 * 1024))
echo "the same with boxtree::paper and boxtree::blob: $(($(bytes "$whole") - less)) bytes"

# What the runtime must not have is in the program that has all.
nm -C "$runtime" >"$work/of_runtime"
nm -C "$whole" >"$work/of_whole"
for name in PackedCodec PlainCodec lzma_ ZSTD_; do
  if grep "$name" "$work/of_runtime"; then fail "the runtime has a codec of the paper, or decompresses"; fi
  grep -q "$name" "$work/of_whole" || fail "the whole runtime has no symbol $name: the list is stale"
done

cook_square wide4 --codec wide4
cook_square packed-f16 --codec packed-f16
cook_square blob --codec blob-zstd
"$whole" "$work/blob.bxt" >/dev/null || fail "the whole runtime does not answer"
"$runtime" "$work/wide4.bxt" >/dev/null || fail "the runtime does not answer"
said=$("$runtime" "$work/packed-f16.bxt") && fail "the runtime answered of a codec of the paper"
case $said in
  *'packed-f16 is a codec of boxtree::paper: link it and call use_paper_codecs()'*) ;;
  *) fail "unclear: '$said'" ;;
esac
echo "size: as expected"
