// SPDX-License-Identifier: MIT
// Queries a file for the closest hit of a ray that falls from above the origin.
#include <cstdio>

#include <boxtree/boxtree.h>

int main(int, char** argv) {
  const auto file = boxtree::File::open(argv[1]);
  if (!file) return std::puts(file.error().detail.c_str()), 1;
  const auto tree = boxtree::Tree::bind(*file);
  if (!tree) return std::puts(tree.error().detail.c_str()), 1;
  const auto hit = boxtree::closest_hit(*tree, {{0, 0, 10}, {0, 0, -1}});
  if (!hit) return 1;
  std::printf("t %g, face %u\n", hit->t, hit->face.id);
}
