// SPDX-License-Identifier: MIT
// The convex hull of points, as a shape: its distance from a triangle, and how it leaves one.
#pragma once

#include <cstdint>
#include <span>

#include "runtime/primitive/convex_shape.h"
#include "runtime/primitive/penetration.h"

namespace boxtree {

/// ConvexPoints::distance.
[[nodiscard]] CoreDistance hull_distance(std::span<const Eigen::Vector3d> points,
                                         const Corners& corner) noexcept;

/// ConvexPoints::penetration. Takes 120 KB of stack.
[[nodiscard]] Penetration hull_penetration(std::span<const Eigen::Vector3d> points,
                                           const Corners& corner, double doubt,
                                           const Eigen::Vector3d* against) noexcept;

/// A point of a Minkowski difference: a corner of a triangle less one of some points.
struct DifferencePoint {
  Eigen::Vector3d at;
  std::uint32_t corner, point;
};

/// The one that is least along a direction; of several the first.
[[nodiscard]] DifferencePoint least_difference(std::span<const Eigen::Vector3d> points,
                                               const Corners& corner,
                                               const Eigen::Vector3d& direction) noexcept;

/// Weights of the corners whose mean is the point of a triangle that is closest to `point`, nearly;
/// none is negative, and their sum is 1 up to rounding.
[[nodiscard]] Eigen::Vector3d weights_in(const Corners& triangle,
                                         const Eigen::Vector3d& point) noexcept;

}  // namespace boxtree
