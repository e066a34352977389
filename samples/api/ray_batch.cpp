// SPDX-License-Identifier: MIT
// A map of heights: a ray down into the middle of each square of the level, a row at a time.
//   ray_batch level.bxt
#include <array>
#include <cstdio>

#include <boxtree/boxtree.h>

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fputs("usage: ray_batch level.bxt\n", stderr);
    return 2;
  }
  const auto file = boxtree::File::open(arguments[1]);
  const auto tree = file ? boxtree::Tree::bind(*file) : file.error();
  if (!tree) {
    std::fprintf(stderr, "%s\n", tree.error().message().c_str());
    return 1;
  }

  constexpr std::size_t kSquares = 10;  // on a side; the level is 8 wide
  std::array<boxtree::Ray, kSquares> rays;
  std::array<boxtree::RayResult, kSquares> hits;
  for (std::size_t row = 0; row < kSquares; ++row) {
    for (std::size_t i = 0; i < kSquares; ++i) {
      const double x = static_cast<double>(i) - 4.5, y = 4.5 - static_cast<double>(row);
      rays[i] = {.origin = {x, y, 10}, .direction = {0, 0, -1}};
    }
    if (!boxtree::closest_hits(*tree, rays, hits).ok()) return 1;
    for (const boxtree::RayResult& hit : hits) {
      if (!hit.ok()) return 1;  // each ray has a result of its own
      hit ? std::printf(" %.2f", hit->point[2]) : std::printf("    -");
    }
    std::printf("\n");
  }
  return 0;
}
