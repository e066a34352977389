#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The arrows point one way: cooker -> runtime -> format. Looks at what sources include and at what
# the built libraries ask the linker for.
#   check_arrows.sh SOURCE_DIR [BUILD_DIR]
set -euo pipefail
source=$1 build=${2:-}
bad=0

# forbid FOLDER REGEX WHY: no include in FOLDER may match.
forbid() {
  local found
  found=$(grep -rnE "^[[:space:]]*#include[[:space:]]*[<\"]($2)" "$source/$1" || true)
  [ -z "$found" ] && return 0
  printf '%s: %s\n%s\n' "$1" "$3" "$found"
  bad=1
}
forbid format 'boxtree/(runtime|cooker)|Eigen|xxhash|assimp|fmt|nlohmann|CLI|toml|tbb|oneapi|hwy' \
  'format uses the C++ standard library alone'
forbid runtime 'boxtree/cooker|assimp|fmt/|nlohmann|CLI|toml|tbb|oneapi|iostream|cstdio' \
  'runtime uses format, Eigen, Highway and xxHash, and prints nothing'

# forbid_symbols LIBRARY REGEX WHY: no undefined symbol may match.
forbid_symbols() {
  local found
  found=$(nm -uC "$build/$1" | grep -E "$2" || true)
  [ -z "$found" ] && return 0
  printf '%s: %s\n%s\n' "$1" "$3" "$found"
  bad=1
}
if [ -n "$build" ]; then
  forbid_symbols format/libboxtree_format.a '\b(printf|puts|abort|exit|std::cout|std::cerr)\b|Assimp|tbb::|XXH' \
    'format prints nothing, ends nothing, links nothing'
  forbid_symbols runtime/libboxtree_runtime.a '\b(printf|puts|abort|exit|std::cout|std::cerr)\b|Assimp|tbb::|fmt::|nlohmann|boxtree::cooker|XXH' \
    'runtime prints nothing, ends nothing, links format and Highway alone'
fi
[ "$bad" -eq 0 ] && echo "arrows point one way"
exit "$bad"
