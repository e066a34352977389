#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the command line below a project with CMAKE_UNITY_BUILD, which compiles several sources as one, as samples/quickstart.sh
# does; without optimisation to save time. It cooks the same bytes and answers the same.
#   unity_test.sh SOURCE COMPILER BOXTREE
set -euo pipefail
source=$1 compiler=$2 boxtree=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
number=0
fail() { echo "unity: $*"; exit 1; }
# shellcheck source=tests/consumer/quiet.sh
. "$source/tests/consumer/quiet.sh"

sets=sse4
if grep -qsw avx2 /proc/cpuinfo; then sets=avx2; fi
quiet cmake -S "$source" -B "$work/build" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Debug \
  -DCMAKE_CXX_FLAGS_DEBUG=-O0 -DCMAKE_UNITY_BUILD=ON -DBOXTREE_INSTRUCTION_SETS=$sets -DBOXTREE_BUILD_TESTS=OFF
quiet cmake --build "$work/build" -j2 --target boxtree_cli
meshes=$source/samples/meshes
for program in "$boxtree" "$work/build/boxtree"; do
  out=$work/$((++number))
  mkdir "$out"
  "$program" cook "$meshes/level.obj" "$meshes/crate.obj" -o "$out/cooked.bxt" --active-edges 5 -q
  "$program" cook "$source/samples/level/level.gltf" -o "$out/scene.bxt" -q
  "$program" verify "$out/cooked.bxt" "$out/scene.bxt" -q
  "$program" query "$out/scene.bxt" ray --origin 1,1,9 --direction 0,0,-1 --json >"$out/ray.json"
  "$program" query "$out/cooked.bxt" point --tree level --at 1,2,3 --json >"$out/point.json"
done
diff -r "$work/1" "$work/2" || fail "other bytes or answers"
echo "unity: as expected"
