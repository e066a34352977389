// SPDX-License-Identifier: MIT
#include "runtime/walk/face_copies.h"

#include <cstddef>

namespace boxtree {

bool part_comes_before(const BoundTree& tree, std::uint32_t a, std::uint32_t b) noexcept {
  TriangleBatch batch;
  std::array<Triangle, 2> part;
  for (std::size_t i = 0; i < part.size(); ++i) {
    // Corrupt bytes give any answer.
    if (tree.leaves().read(i == 0 ? a : b, 1, batch) != Errc::kOk) return a < b;
    part[i] = batch.triangle(0);
  }
  for (std::size_t c = 0; c < part[0].corner.size(); ++c) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      const double x = part[0].corner[c][k], y = part[1].corner[c][k];
      if (x != y) return x < y;
    }
  }
  return a < b;
}

}  // namespace boxtree
