// SPDX-License-Identifier: MIT
// How high is the ground at (2.5, 0)?
//   first level.bxt
#include <cstdio>

#include <boxtree/boxtree.h>

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fputs("usage: first level.bxt\n", stderr);
    return 2;
  }
  const auto file = boxtree::File::open(arguments[1]);
  const auto tree = file ? boxtree::Tree::bind(*file) : file.error();
  if (!tree) {
    std::fprintf(stderr, "%s\n", tree.error().message().c_str());
    return 1;
  }

  if (const auto hit = boxtree::closest_hit(*tree, {{2.5, 0, 10}, {0, 0, -1}})) {
    std::printf("ground at height %g, face %u\n", hit->point[2], hit->face.id);
  }
  return 0;
}
