// SPDX-License-Identifier: MIT
#include "cooker/import/f32_digits.h"

#include <algorithm>
#include <limits>

#include <Eigen/Geometry>

namespace boxtree::cooker {

bool has_few_digits(const Positions& positions) {
  constexpr int kBits = 16;
  constexpr int kBitsTaken = std::numeric_limits<float>::digits - kBits;
  Eigen::AlignedBox3d bounds;
  for (std::size_t i = 0; i < positions.size(); ++i) bounds.extend(positions[i]);
  if (bounds.isEmpty()) return false;
  const double farthest =
      std::max(bounds.min().cwiseAbs().maxCoeff(), bounds.max().cwiseAbs().maxCoeff());
  return farthest > bounds.sizes().maxCoeff() * (1 << kBitsTaken);
}

double moved_by_f32(const Positions& positions) {
  double farthest = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Eigen::Vector3d p = positions[i];
    farthest = std::max(farthest, (p - p.cast<float>().cast<double>()).norm());
  }
  return farthest;
}

}  // namespace boxtree::cooker
