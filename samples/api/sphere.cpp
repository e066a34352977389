// SPDX-License-Identifier: MIT
// What does a ball of radius 0.75 touch, and how does each face lie?
//   sphere level.bxt
#include <cstdio>

#include <boxtree/boxtree.h>

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fputs("usage: sphere level.bxt\n", stderr);
    return 2;
  }
  const auto file = boxtree::File::open(arguments[1]);
  const auto tree = file ? boxtree::Tree::bind(*file) : file.error();
  if (!tree) {
    std::fprintf(stderr, "%s\n", tree.error().message().c_str());
    return 1;
  }

  const Eigen::Vector3d center(2.5, 0, 1);
  const auto visit =
      boxtree::overlap_sphere(*tree, center, 0.75, [&](const boxtree::FaceRef& face) {
        const auto triangle = tree->triangle(face);
        if (!triangle) return false;
        std::printf("face %u at height %g\n", face.id, triangle->corner[0][2]);
        return true;
      });
  return visit ? 0 : 1;
}
