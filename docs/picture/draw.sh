#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Draws the picture of the README: the bunny of Debian's glmark2-data, cooked and exported.
#   docs/picture/draw.sh [BOXTREE [PICTURE]]   [build/boxtree docs/picture/boxes.png]
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
boxtree=${1:-$here/../../build/boxtree}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$boxtree" cook /usr/share/glmark2/models/bunny.obj -o "$work/bunny.bxt" --quiet
"$boxtree" export "$work/bunny.bxt" -o "$work/bunny.obj" --triangles --levels 1-4 >/dev/null
# Debian's python3-pil is for Debian's interpreter.
/usr/bin/python3 "$here/draw_boxes.py" "$work/bunny.obj" "${2:-$here/boxes.png}"
