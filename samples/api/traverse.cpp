// SPDX-License-Identifier: MIT
// How much of the level is below the water? A half-space is a shape that no query has.
//   traverse level.bxt
#include <cstdio>

#include <boxtree/boxtree.h>

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fputs("usage: traverse level.bxt\n", stderr);
    return 2;
  }
  const auto file = boxtree::File::open(arguments[1]);
  const auto tree = file ? boxtree::Tree::bind(*file) : file.error();
  if (!tree) {
    std::fprintf(stderr, "%s\n", tree.error().message().c_str());
    return 1;
  }

  const double water = 0.375;
  double area = 0;
  const auto visit = boxtree::traverse(
      *tree, [&](const Eigen::AlignedBox3d& box) { return box.min()[2] <= water; },
      [&](const boxtree::LeafTriangle& leaf) {
        const auto& corner = leaf.triangle.corner;
        if (corner[0][2] > water || corner[1][2] > water || corner[2][2] > water) return true;
        area += (corner[1] - corner[0]).cross(corner[2] - corner[0]).norm() / 2;
        return true;
      });
  if (!visit) return 1;
  std::printf("%g square metres\n", area);
  return 0;
}
