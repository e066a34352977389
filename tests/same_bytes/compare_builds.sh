#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The bytes of other compilers, optimisations, standard libraries and machines against the pinned
# ones. Builds boxtree_same_bytes for each, with the flags of the project (see standalone/). Prints
# PASS, FAIL or SKIP a build; exit 1 when one fails. Some seven minutes of processor time.
#   tests/same_bytes/compare_builds.sh [FOLDER [NAME...]]    default: build/compare_builds, all
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
work=${1:-$here/../../build/compare_builds}
mkdir -p "$work"
work=$(cd "$work" && pwd)
shift $(($# > 0 ? 1 : 0))
wanted=("$@")
failed=0

fail() {
  echo "FAIL $1: $2"
  failed=1
}

# compare NAME COMPILER FLAGS RUNNER [OPTION...]: configures, builds, runs and compares.
compare() {
  local name=$1 compiler=$2 flags=$3 runner=$4 folder=$work/$1 tool
  shift 4
  [[ ${#wanted[@]} -eq 0 || " ${wanted[*]} " == *" $name "* ]] || return 0
  for tool in "$compiler" ${runner:+"$runner"}; do
    command -v "$tool" >/dev/null || { echo "SKIP $name: $tool is not installed"; return 0; }
  done
  rm -rf "$folder"
  if ! cmake -S "$here/standalone" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=None \
    -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_CXX_FLAGS="$flags" "$@" >"$folder.log" 2>&1 ||
    ! cmake --build "$folder" >>"$folder.log" 2>&1; then
    grep -E 'error:|Error' "$folder.log" | head -5
    fail "$name" "does not build, see $folder.log"
  elif ! ${runner:+"$runner"} "$folder/boxtree_same_bytes" >"$folder.txt" 2>>"$folder.log"; then
    tail -5 "$folder.log"
    fail "$name" "does not run to its end"
  elif ! diff "$here/pinned.txt" "$folder.txt" >"$folder.diff"; then
    grep '^[<>]' "$folder.diff" | head -20
    fail "$name" "other bytes than pinned, see $folder.diff"
  else
    echo "PASS $name"
  fi
}

compare g++-O0 g++ -O0 ""
compare g++-O3-native g++ "-O3 -march=native" ""
compare clang++-O0 clang++ -O0 ""
compare clang++-O3-native clang++ "-O3 -march=native" ""
# Its sorts and partitions are others than those of libstdc++.
if echo '#include <version>' | clang++ -stdlib=libc++ -x c++ -fsyntax-only - 2>/dev/null; then
  compare clang++-libc++ clang++ "-O2 -stdlib=libc++" "" -DBOXTREE_OWN_THREADS=ON
else
  echo "SKIP clang++-libc++: clang++ or libc++ is not installed"
fi
# Headers of libraries that are nothing but headers are those of this machine; they come last, so
# that the other machine's C library is its own.
compare arm64 aarch64-linux-gnu-g++ "-O3 -idirafter /usr/include" qemu-aarch64-static \
  -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR=aarch64 -DCMAKE_EXE_LINKER_FLAGS=-static \
  -DBOXTREE_OWN_THREADS=ON
exit "$failed"
