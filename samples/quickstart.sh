#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# From a fresh Debian 12 to answered queries: installs what is missing, builds (three minutes on two
# cores), cooks real meshes from Debian's own packages, queries them, and writes a report page.
set -euo pipefail
cd "$(dirname "$0")/.."
# shellcheck source=samples/packages.sh
. samples/packages.sh
# shellcheck disable=SC2086 # lists of words
install_missing $BUILD_PACKAGES $SAMPLE_PACKAGES

say() { printf '\n== %s\n' "$*"; }

say "build in build/quickstart"
# One set of instructions suffices for what runs here alone; sources of the runtime take a third of the time together.
sets=sse4
if grep -qsw avx2 /proc/cpuinfo; then sets=avx2; fi
cmake -S . -B build/quickstart -G Ninja -DCMAKE_BUILD_TYPE=Release -DBOXTREE_BUILD_TESTS=OFF \
  -DBOXTREE_INSTRUCTION_SETS=$sets -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=0 >/dev/null
# Ninja counts in one line of a terminal; elsewhere every third step is a line. (mawk would keep them until it has 4 KB.)
every_third() {
  local line step=0
  while IFS= read -r line; do
    if [[ $line != \[* ]] || ((step++ % 3 == 0)); then printf '%s\n' "$line"; fi
  done
}
if [ -t 1 ]; then
  NINJA_STATUS='[%f/%t files, %e s] ' ninja -C build/quickstart -j"$(nproc)" boxtree_cli
else
  NINJA_STATUS='[%f/%t files, %e s] ' ninja -C build/quickstart -j"$(nproc)" boxtree_cli | every_third
fi
boxtree=build/quickstart/boxtree
out=build/quickstart/cooked
mkdir -p "$out"

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
run query "$out/horse.bxt" box --min=-0.1,0.3,-0.9 --max 0.1,0.4,0.9
say "the closest point"
run query "$out/cat.bxt" point --at 1,2,3
say "two meshes against each other"
run query "$out/bunny.bxt" pair "$out/horse.bxt" --pose 0.1,0,0 --first
say "which encoding to take, and what it costs"
run report /usr/share/glmark2/models/bunny.obj -o "$out/bunny.html" --quick
say "done"
echo "the report page:  $(realpath "$out/bunny.html")"
echo "the cooked files: $(realpath "$out")"
echo "the program:      $(realpath "$boxtree"), as in $boxtree help cook"
