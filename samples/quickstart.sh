#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# From a fresh Debian 12 to answered queries: installs what is missing, builds, cooks real meshes
# from Debian's own packages, and queries them.
set -euo pipefail
cd "$(dirname "$0")/.."
# shellcheck source=samples/packages.sh
. samples/packages.sh
# shellcheck disable=SC2086 # lists of words
install_missing $BUILD_PACKAGES $SAMPLE_PACKAGES

cmake -S . -B build/quickstart -G Ninja -DCMAKE_BUILD_TYPE=Release -DBOXTREE_BUILD_TESTS=OFF >/dev/null
ninja -C build/quickstart boxtree_cli >/dev/null
boxtree=build/quickstart/boxtree
out=build/quickstart/cooked
mkdir -p "$out"

say() { printf '\n== %s\n' "$*"; }
run() { printf '$ boxtree %s\n' "$*"; "$boxtree" "$@"; }

say "cook"
for mesh in /usr/share/glmark2/models/bunny.obj /usr/share/glmark2/models/horse.3ds \
  /usr/share/glmark2/models/cat.3ds /usr/share/assimp/models/OBJ/spider.obj; do
  name=$(basename "${mesh%.*}")
  run cook "$mesh" -o "$out/$name.bxt"
  run verify "$out/$name.bxt"
done
say "what is in the file"
run info "$out/bunny.bxt"
say "a ray"
run query "$out/bunny.bxt" ray --origin 0,0,10 --direction 0,0,-1
say "a box"
run query "$out/horse.bxt" box --min=-0.05,-0.05,-0.05 --max 0.05,0.05,0.05
say "the closest point"
run query "$out/cat.bxt" point --at 1,2,3
say "two meshes against each other"
run query "$out/bunny.bxt" pair "$out/horse.bxt" --pose 0.1,0,0 --first
say "done: the cooked files are in $out; '$boxtree --help' shows the rest"
