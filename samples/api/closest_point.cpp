// SPDX-License-Identifier: MIT
// How far is the level, exactly and to a tenth?
//   closest_point level.bxt
#include <cstdio>

#include <boxtree/boxtree.h>

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fputs("usage: closest_point level.bxt\n", stderr);
    return 2;
  }
  const auto file = boxtree::File::open(arguments[1]);
  const auto tree = file ? boxtree::Tree::bind(*file) : file.error();
  if (!tree) {
    std::fprintf(stderr, "%s\n", tree.error().message().c_str());
    return 1;
  }

  const Eigen::Vector3d lamp(0, 0, 2);
  const auto nearest = boxtree::closest_point(*tree, lamp);
  if (!nearest) return 1;  // nothing, or an error
  std::printf("distance %g to face %u\n", nearest->distance, nearest->face.id);

  const auto bounds =
      boxtree::closest_point(*tree, lamp, boxtree::PointOptions{.relative_error = 0.1});
  if (!bounds) return 1;
  std::printf("between %.3f and %.3f\n", bounds->lower, bounds->upper);

  const auto near_by = boxtree::closest_point(*tree, lamp, 1.5);  // no farther than that
  std::printf("within 1.5: %s\n", near_by ? "something" : "nothing");
  return near_by.ok() ? 0 : 1;
}
