// SPDX-License-Identifier: MIT
// Scaling and rotating the points of a hull, and what makes one invalid.
#include "runtime/query/hull_in_tree.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "runtime/primitive/expansion.h"
#include "runtime/primitive/rounding.h"
#include "runtime/primitive/vector3.h"

namespace boxtree {

HullInTree::HullInTree(const Frame& frame, const ConvexHull& hull) noexcept {
  // A box along the axes of the points, whose center and half extents are not known yet.
  OrientedBox box;
  box.center = hull.position;
  box.rotation = hull.rotation;
  shape_ = in_tree(frame, box);
  if (!is_within_range(frame.to_tree(hull.position))) shape_.invalid = "position";
  if (shape_.invalid != nullptr) return;
  if (hull.points.empty() || hull.points.size() > kMaxHullPoints) {
    shape_.invalid = "points";
    return;
  }
  Eigen::Vector3d low = hull.points[0], high = low;
  bool is_finite = true;
  for (const Eigen::Vector3d& point : hull.points) {
    is_finite &= std::isfinite(largest_magnitude(point));
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  // Whatever rounding makes of the middle, it is subtracted.
  const Eigen::Vector3d middle = low / 2 + high / 2;
  const std::array<Eigen::Vector3d, 3>& axis = shape_.shape.axis;
  const auto rotated = [&](const Eigen::Vector3d& v) -> Eigen::Vector3d {
    return (v[0] * axis[0] + v[1] * axis[1]) + v[2] * axis[2];
  };
  const Eigen::Vector3d to_middle = rotated(middle);
  Eigen::Vector3d rest;  // what the sum rounds
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Rounded sum = two_sum(hull.position[k], to_middle[k]);
    shape_.center[k] = sum.value;
    rest[k] = sum.error;
  }
  const double scale = frame.inverse_scale;
  double size = 0;
  for (std::size_t i = 0; i < hull.points.size() && is_finite; ++i) {
    const Eigen::Vector3d from_middle = hull.points[i] - middle;
    points_[i] = scale * (rotated(from_middle) + rest);
    for (std::size_t k = 0; k < 3; ++k) {
      double& half = shape_.shape.half[k];
      half = std::max(half, std::abs(scale * from_middle[static_cast<Eigen::Index>(k)]));
    }
    size = std::max(size, largest_magnitude(points_[i]));
  }
  if (!is_finite || !(size <= kMaxCoordinate) || !is_within_range(frame.to_tree(shape_.center))) {
    shape_.invalid = "points";
    return;
  }
  // By what the rotation rounds, of the points and of the middle. The identity rounds nothing.
  shape_.shape.error =
      32 * kRoundoffF64 * (hull.rotation.vec().isZero(0) ? 0.0 : scale * largest_magnitude(middle));
  for (double& half : shape_.shape.half) {
    half = half * (1 + 32 * kRoundoffF64) + 32 * kRoundoffF64 * size + shape_.shape.error +
           2 * scale * largest_magnitude(rest);
  }
  points_of_shape_.point = {points_.data(), hull.points.size()};
  shape_.shape.hull = &points_of_shape_;
}
}  // namespace boxtree
