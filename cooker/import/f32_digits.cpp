// SPDX-License-Identifier: MIT
#include "cooker/import/f32_digits.h"

#include <algorithm>

#include <Eigen/Geometry>

#include "runtime/primitive/rounding.h"

namespace boxtree::cooker {

namespace {

double unnoticed_in(const Eigen::AlignedBox3d& bounds) {
  constexpr double kHalfStep = 0x1p-17;
  return bounds.isEmpty() ? 0 : kHalfStep * bounds.sizes().maxCoeff();
}

}  // namespace

double unnoticed_move(const Positions& positions) {
  return unnoticed_in(bounds_of(positions));
}

bool may_have_moved(const Positions& positions) {
  const Eigen::AlignedBox3d bounds = bounds_of(positions);
  if (bounds.isEmpty()) return false;
  const Eigen::Vector3d farthest = bounds.min().cwiseAbs().cwiseMax(bounds.max().cwiseAbs());
  return kRoundoffF32 * farthest.norm() > unnoticed_in(bounds);
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
