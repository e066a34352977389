#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# boxtree_c.h by itself, as C and as C++ of old and new standards, without a warning, by each compiler that is there.
#   header_test.sh FOLDER_OF_THE_HEADER
set -euo pipefail
include=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cat >"$work/use.c" <<'END'
#include <boxtree_c.h>
bxt_status use(const bxt_tree* tree);
bxt_status use(const bxt_tree* tree) {
  const bxt_ray ray = {{0, 0, 10}, {0, 0, -1}, 0, INFINITY};
  const bxt_vec3 zero = {0, 0, 0};
  const bxt_shape shape = bxt_box(zero, zero, bxt_no_rotation());
  bxt_face_options options = bxt_default_face_options();
  bxt_ray_hit hit = {0};
  hit.struct_size = (uint32_t)sizeof hit;
  options.nodes = shape.point_count;
  return bxt_tree_closest_hit(tree, &ray, &options, &hit, NULL);
}
END
sed 's/{0};/{};/' "$work/use.c" >"$work/use.cpp"
warnings=(-Wall -Wextra -Werror -pedantic-errors -Wshadow -Wconversion -Wstrict-aliasing)
count=0
compiles() {
  command -v "$1" >/dev/null || return 0
  "$@" "${warnings[@]}" -I "$include" -c -o "$work/use.o" || { echo "not by: $*"; exit 1; }
  count=$((count + 1))
}
for standard in c99 c11 c17; do
  for compiler in gcc clang; do
    compiles $compiler "-std=$standard" -Wstrict-prototypes -Wmissing-prototypes "$work/use.c"
  done
done
for standard in c++11 c++17 c++20; do
  for compiler in g++ clang++; do compiles $compiler "-std=$standard" "$work/use.cpp"; done
done
test $count -ge 6
echo "boxtree_c.h compiles in $count ways"
