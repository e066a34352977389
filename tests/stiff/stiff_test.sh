#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# boxtree_stiff: a line for each figure, the same figures as JSON, plots that are SVG, and an exit
# status that tells whether all limits were kept.
#   stiff_test.sh BOXTREE_STIFF
set -euo pipefail
stiff=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$stiff" --quick --case S5 --case S6 --json "$work/out.json" --plots "$work/plots" >"$work/lines"
[ "$(wc -l <"$work/lines")" -eq "$(jq '.rows | length' "$work/out.json")" ] ||
  { echo "lines and rows differ"; exit 1; }
[ "$(jq -c '[.rows[].id] | unique' "$work/out.json")" = '["S5","S6"]' ] ||
  { echo "unexpected cases"; exit 1; }
[ "$(jq '.pass' "$work/out.json")" = true ] ||
  { echo "a limit was missed"; cat "$work/lines"; exit 1; }
[ "$(jq '[.rows[] | select(.limit != "-" and .pass != true)] | length' "$work/out.json")" -eq 0 ]
python3 - "$work"/plots/*.svg <<'PY'
import sys, xml.etree.ElementTree as tree
for path in sys.argv[1:]:
    root = tree.parse(path).getroot()
    assert root.tag == "{http://www.w3.org/2000/svg}svg", path
    paths = root.findall("{http://www.w3.org/2000/svg}path")
    lines = [path for path in paths if path.get("class") == "line"]
    assert lines and all(line.get("d").count("L") > 100 for line in lines), path
PY
status=0
"$stiff" --case S7 >/dev/null 2>&1 || status=$?
[ "$status" -ne 0 ] || { echo "an unknown case was accepted"; exit 1; }
