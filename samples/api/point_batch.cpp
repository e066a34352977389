// SPDX-License-Identifier: MIT
// How much room is there? The clearance around points of a path, three above each of its places.
//   point_batch level.bxt
#include <array>
#include <cstdio>

#include <boxtree/boxtree.h>

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fputs("usage: point_batch level.bxt\n", stderr);
    return 2;
  }
  const auto file = boxtree::File::open(arguments[1]);
  const auto tree = file ? boxtree::Tree::bind(*file) : file.error();
  if (!tree) {
    std::fprintf(stderr, "%s\n", tree.error().message().c_str());
    return 1;
  }

  constexpr std::size_t kHeights = 3, kPlaces = 5;
  std::array<Eigen::Vector3d, kPlaces * kHeights> points;  // those of a place follow each other
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto place = static_cast<double>(i / kHeights),
               height = static_cast<double>(i % kHeights);
    points[i] = {place - 2, 0, 0.5 + height};
  }
  std::array<boxtree::PointResult, points.size()> nearest;
  if (!boxtree::closest_points(*tree, points, nearest, 1.25).ok()) return 1;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!nearest[i].ok()) return 1;  // each point has a result of its own
    nearest[i] ? std::printf(" %.2f", nearest[i]->distance) : std::printf("    -");
    if (i % kHeights == kHeights - 1) std::printf("\n");
  }
  return 0;
}
