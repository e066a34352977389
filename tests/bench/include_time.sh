#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What including the whole public API costs a compiler, beside <Eigen/Geometry> alone: the least of
# several runs by turns, in seconds of processor time.
#   tests/bench/include_time.sh [BUILD_DIR] [RUNS]     CXX chooses the compiler
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
build=${1:-$root/build} runs=${2:-7} compiler=${CXX:-c++}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
eigen=$(sed -n 's/^Eigen3_DIR:[A-Z]*=//p' "$build/CMakeCache.txt")/../../../include/eigen3
echo '#include <boxtree/boxtree.h>' >"$work/boxtree.cpp"
echo '#include <Eigen/Geometry>' >"$work/eigen.cpp"

# seconds NAME: of processor time.
seconds() {
  local TIMEFORMAT=%U
  { time "$compiler" -std=c++20 -O2 -I "$root/format/include" -I "$root/runtime/include" -I "$build/include" \
    -isystem "$eigen" -c "$work/$1.cpp" -o "$work/$1.o"; } 2>&1
}

for ((i = 0; i < runs; i++)); do
  for name in boxtree eigen; do echo "$name $(seconds $name)"; done
done | awk '
  !($1 in least) || $2 < least[$1] { least[$1] = $2 }
  END {
    printf "<boxtree/boxtree.h> %.2f s, <Eigen/Geometry> %.2f s, ratio %.2f\n",
           least["boxtree"], least["eigen"], least["boxtree"] / least["eigen"]
  }'
