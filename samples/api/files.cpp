// SPDX-License-Identifier: MIT
// What is in a file?
//   files level-and-crate.bxt
#include <cstdio>

#include <boxtree/boxtree.h>

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fputs("usage: files level-and-crate.bxt\n", stderr);
    return 2;
  }
  const auto file = boxtree::File::open(arguments[1]);
  if (!file) {
    std::fprintf(stderr, "%s\n", file.error().message().c_str());
    return 1;
  }
  for (std::uint32_t i = 0; i < file->tree_count(); ++i) {
    const auto tree = boxtree::Tree::bind(*file, i);
    if (!tree) return 1;
    const Eigen::Vector3d size = tree->bounds().sizes();
    std::printf("%.*s: %u faces, %u triangles, %.3g x %.3g x %.3g\n", int(tree->name().size()),
                tree->name().data(), tree->face_count(), tree->triangle_count(), size[0], size[1],
                size[2]);
  }
  const auto crate = file->find_tree("crate");
  if (crate) std::printf("the crate is tree %u\n", *crate);
  return crate ? 0 : 1;
}
