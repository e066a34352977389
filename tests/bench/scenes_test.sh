#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# boxtree_scenes: both ways answer alike but for the rounding of merged vertices to f32, and the
# scene takes less than a tenth of the bytes. No time is looked at.
#   scenes_test.sh BOXTREE_SCENES
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for codec in wide8 wide4; do
  "$1" --instances 300 --queries 2000 --rounds 1 --codec "$codec" --json >"$work/out"
  jq -e '.scene_bytes * 10 < .merged_bytes' "$work/out" >/dev/null || { cat "$work/out"; exit 1; }
  jq -e '.rows | length == 5 and all(.scene_answers > 0 and
         ((.scene_answers - .merged_answers) | fabs) <= 1e-3 * .merged_answers)' "$work/out" >/dev/null ||
    { cat "$work/out"; exit 1; }
done
