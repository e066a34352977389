// SPDX-License-Identifier: MIT
// How much of the level is stair? Two threads query one tree.
//   threads level.bxt
#include <atomic>
#include <cstdio>
#include <thread>

#include <boxtree/boxtree.h>

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fputs("usage: threads level.bxt\n", stderr);
    return 2;
  }
  const auto file = boxtree::File::open(arguments[1]);
  const auto tree = file ? boxtree::Tree::bind(*file) : file.error();
  if (!tree) {
    std::fprintf(stderr, "%s\n", tree.error().message().c_str());
    return 1;
  }

  std::atomic<int> hits = 0;
  const auto scan = [&](int first_row, int last_row) {
    for (int row = first_row; row < last_row; ++row) {
      for (int column = 0; column < 80; ++column) {
        const Eigen::Vector3d above(-4 + (column + 0.5) / 10, -4 + (row + 0.5) / 10, 10);
        const auto hit = boxtree::closest_hit(*tree, {above, {0, 0, -1}});
        if (hit && hit->face.id > 0) ++hits;
      }
    }
  };
  std::thread other(scan, 0, 40);
  scan(40, 80);
  other.join();
  std::printf("%d of 6400 rays meet the stair\n", hits.load());
  return 0;
}
