#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A check that cannot fail proves nothing: plants includes against the order of folders and expects each to be refused.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/format" "$work/runtime/query" "$work/runtime/include/boxtree" "$work/cooker/write"
check() { python3 "$here/check_dependencies.py" "$work"; }

# refused FILE INCLUDE WHY: the check must say WHY of that one line.
refused() {
  local said
  printf '%s\n' "#include $2" >"$work/$1"
  if said=$(check); then echo "the check missed $2 in $1"; exit 1; fi
  [[ $said == "$1: "*": $3" ]] || { echo "of $2 in $1 the check printed: "; exit 1; }
  rm "$work/$1"
}

printf '%s\n' '#include <cstdint>' '#include <boxtree/error.h>' '#include "format/limits.h"' \
  >"$work/format/good.h"
printf '%s\n' '#include <Eigen/Core>' '#include "runtime/walk/work.h"' '#include <boxtree/ray.h>' \
  >"$work/runtime/query/good.h"
check
refused format/bad.h '<boxtree/boxtree.h>' 'format does not depend on the runtime'
refused format/bad.h '"runtime/file/mapping.h"' 'format comes before runtime'
refused format/bad.h '<Eigen/Core>' 'format does not use Eigen/Core'
refused format/bad.h '<iostream>' 'format prints nothing'
refused runtime/query/bad.h '"cooker/cook.h"' 'runtime comes before cooker'
refused runtime/query/bad.h '"runtime/scene/bound_scene.h"' 'runtime/query comes before runtime/scene'
refused runtime/include/boxtree/bad.h '"runtime/tree/bound_tree.h"' \
  'a public header includes nothing private'
refused runtime/include/boxtree/bad.h '<format/codec.h>' 'a public header includes nothing private'
refused runtime/include/boxtree_c.h '<boxtree/ray.h>' 'the C interface includes C99 alone'
refused runtime/query/bad.h '<boxtree_c.h>' 'only runtime/c knows the C interface'
refused runtime/query/bad.h '"runtime/wide/ray.h"' \
  "runtime/wide is missing in the order of runtime's folders"
refused runtime/query/bad.h '<runtime/walk/work.h>' \
  'a private header is included by its path in quotes: "runtime/walk/work.h"'
refused cooker/write/bad.cpp '"cooker/scene/profile.h"' 'cooker/write comes before cooker/scene'
refused cooker/write/bad.cpp '<CLI/CLI.hpp>' 'only cooker/cli/command_app.h may include CLI/CLI.hpp'
refused cooker/write/bad.cpp '<nlohmann/json.hpp>' \
  'only cooker/text/json.cpp may include nlohmann/json.hpp'
refused cooker/write/bad.cpp '"work.h"' 'only a header of the project is included in quotes'
echo "every planted include was refused"
