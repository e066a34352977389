#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The peak of a cook's memory, the program included: at most 150 bytes per triangle of a large mesh.
#   cook_memory_test.sh BOXTREE BOXTREE_GENERATE
set -euo pipefail
boxtree=$1 generate=$2
limit=150
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

failed=0
for kind in terrain city; do
  "$generate" "$kind" 500000 "$work/mesh.ply"
  for options in "" "--exact" "--for memory" "--for speed"; do
    # shellcheck disable=SC2086 # options are words
    taken=$("$boxtree" cook "$work/mesh.ply" -o "$work/mesh.bxt" --jobs 2 --json $options |
      jq '.peak_bytes / .trees[0].triangles | ceil')
    [ "$taken" -le "$limit" ] ||
      { echo "$kind $options: $taken bytes per triangle, more than $limit"; failed=1; }
  done
done
exit "$failed"
