#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the runtime with its vectors and without a build type, as in a program whose CMake sets none, and runs
# every query. Where nothing is inlined, functions of several sources that have one name and differ are one function:
# calls by instruction set went to null pointers.
# Each source alone, which is what that takes.
#   unoptimised_test.sh SOURCE COMPILER BOXTREE
set -euo pipefail
source=$1 compiler=$2 boxtree=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "unoptimised: $*"; exit 1; }
# shellcheck source=tests/consumer/quiet.sh
. "$source/tests/consumer/quiet.sh"

cat >"$work/CMakeLists.txt" <<CMAKE
cmake_minimum_required(VERSION 3.25)
project(unoptimised LANGUAGES CXX)
set(BOXTREE_BUILD_COOKER OFF)
add_subdirectory($source boxtree)
add_executable(queries $source/tests/size/programs/runtime.cpp)
target_link_libraries(queries PRIVATE boxtree::runtime)
CMAKE
quiet cmake -S "$work" -B "$work/build" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=
quiet cmake --build "$work/build" -j2 --target queries
# Nor does the library bring a function of that kind to other sources of the program.
nm -C "$work/build/boxtree/runtime/libboxtree_runtime.a" >"$work/symbols"
if grep 'ChosenTarget::GetIndex' "$work/symbols"; then fail "indices of HWY_DYNAMIC_DISPATCH"; fi

# Full leaves of each store: hills of 968 triangles.
awk 'BEGIN {
  n = 23
  for (y = 0; y < n; ++y) for (x = 0; x < n; ++x) printf "v %.4f %.4f %.4f\n", x / 7, y / 7, sin(x / 3) * cos(y / 4)
  for (y = 1; y < n; ++y) for (x = 1; x < n; ++x) {
    a = (y - 1) * n + x
    print "f", a, a + 1, a + n + 1
    print "f", a, a + n + 1, a + n
  }
}' >"$work/hills.obj"
for codec in wide8 wide4; do
  for store in "--exact --for memory" "--exact --for speed" "--grid-bits 24"; do
    read -ra options <<<"$store"
    quiet "$boxtree" cook "$work/hills.obj" -o "$work/hills.bxt" --codec $codec "${options[@]}" -q
    quiet "$work/build/queries" "$work/hills.bxt"
  done
done
# Found by the platform O0: lanes of leaves that are not full looked up what assertions of Highway refuse.
for golden in "$source"/tests/golden/v1.0-wide*.hex; do
  python3 -c 'import sys; sys.stdout.buffer.write(bytes.fromhex(sys.stdin.read()))' <"$golden" >"$work/golden.bxt"
  quiet "$work/build/queries" "$work/golden.bxt"
done
echo "unoptimised: as expected"
