// SPDX-License-Identifier: MIT
// Which faces are in a room, and is anything in another one?
//   box level.bxt
#include <cstdio>
#include <set>

#include <boxtree/boxtree.h>

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fputs("usage: box level.bxt\n", stderr);
    return 2;
  }
  const auto file = boxtree::File::open(arguments[1]);
  const auto tree = file ? boxtree::Tree::bind(*file) : file.error();
  if (!tree) {
    std::fprintf(stderr, "%s\n", tree.error().message().c_str());
    return 1;
  }

  std::set<unsigned> faces;
  const Eigen::AlignedBox3d room(Eigen::Vector3d(1.5, -0.5, 0), Eigen::Vector3d(2.5, 0.5, 1));
  const auto visit = boxtree::overlap_box(*tree, room, [&](const boxtree::FaceRef& face) {
    faces.insert(face.id);
    return true;  // go on
  });
  if (!visit) return 1;
  for (const unsigned face : faces) std::printf("face %u\n", face);

  const Eigen::AlignedBox3d air(Eigen::Vector3d(-3, -3, 0.25), Eigen::Vector3d(-2, -2, 1));
  const auto first =
      boxtree::overlap_box(*tree, air, [](const boxtree::FaceRef&) { return false; });
  if (!first) return 1;
  std::printf("%s\n", *first == boxtree::Visit::kStopped ? "something" : "nothing");
  return 0;
}
