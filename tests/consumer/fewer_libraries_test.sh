#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the command line without each library that may be left out, as for Windows: it links, cooks the same bytes
# as that of the build under test, and says what it does not have.
#   fewer_libraries_test.sh SOURCE COMPILER BOXTREE
set -euo pipefail
source=$1 compiler=$2 boxtree=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "fewer libraries: $*"; exit 1; }
# shellcheck source=tests/consumer/quiet.sh
. "$source/tests/consumer/quiet.sh"

quiet cmake -S "$source" -B "$work/build" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG= \
  -DBOXTREE_ASSIMP=OFF -DBOXTREE_BLOB=OFF -DBOXTREE_TBB=OFF -DBOXTREE_HTTP=OFF -DBOXTREE_BUILD_TESTS=OFF \
  -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=0
quiet cmake --build "$work/build" -j2 --target boxtree_cli
fewer=$work/build/boxtree
cd "$work"
if ldd "$fewer" | grep -E 'assimp|pugixml|lzma|zstd|tbb|curl'; then fail "links what was left out"; fi

for options in "--codec wide8 --exact" "--codec wide4 --grid-bits 21" "--codec packed-f16"; do
  read -ra words <<<"$options"
  quiet "$boxtree" cook "$source/samples/meshes/level.obj" -o whole.bxt -q "${words[@]}"
  quiet "$fewer" cook "$source/samples/meshes/level.obj" -o fewer.bxt -q "${words[@]}"
  cmp whole.bxt fewer.bxt || fail "cook $options: other bytes"
  quiet "$fewer" verify fewer.bxt
done

# refused STATUS WORDS COMMAND...
refused() {
  local status=$1 words=$2 found=0
  shift 2
  "$fewer" "$@" >out 2>err || found=$?
  [ $found = "$status" ] || fail "$*: exit status $found, expected $status: $(cat err)"
  grep -qF -- "$words" err || fail "$*: expected '$words', found '$(cat err)'"
}
quiet "$boxtree" cook "$source/samples/meshes/crate.obj" -o blob.bxt -q --codec blob-zstd
quiet "$boxtree" export whole.bxt -o level.glb
refused 5 assimp cook level.glb -o level.bxt
refused 5 blob verify blob.bxt
echo "fewer libraries: as expected"
