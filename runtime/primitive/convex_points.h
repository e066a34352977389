// SPDX-License-Identifier: MIT
// The convex hull of points, as a shape: its distance from a triangle, and how it leaves one.
#pragma once

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

/// Weights of the corners whose mean is the point of a triangle that is closest to `point`, nearly;
/// none is negative, and their sum is 1 up to rounding.
[[nodiscard]] Eigen::Vector3d weights_in(const Corners& triangle,
                                         const Eigen::Vector3d& point) noexcept;

}  // namespace boxtree
