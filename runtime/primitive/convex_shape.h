// SPDX-License-Identifier: MIT
// The convex shapes that queries take, and what one needs to know of one and a triangle: distance,
// where they touch, on what part of the triangle. Triangles are relative to the shape's center, so
// that what is far from the origin is computed with the digits of its own size.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include <boxtree/shape.h>

#include "runtime/primitive/triangle.h"

namespace boxtree {

using Corners = std::array<Eigen::Vector3d, 3>;

/// All points within `radius` of center + [-1, 1] half[0] axis[0] + ... over `axes` axes: a sphere
/// (no axis), a capsule (one) or a box (three, then without a radius).
struct ConvexShape {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  // Of length 1 but for rounding; of a capsule, any.
  std::array<Eigen::Vector3d, 3> axis = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                                         Eigen::Vector3d::Zero()};
  std::array<double, 3> half{};
  std::uint32_t axes = 0;
  double radius = 0;

  /// Half the extent of its bounds, on every axis, not rounded down.
  [[nodiscard]] Eigen::Vector3d half_extents() const noexcept;
  /// Of a ball around its center that holds it, not rounded down.
  [[nodiscard]] double outer_radius() const noexcept;
};

/// Relative to a point.
[[nodiscard]] inline Corners relative_to(const Eigen::Vector3d& point,
                                         const Triangle& triangle) noexcept {
  return {triangle.corner[0] - point, triangle.corner[1] - point, triangle.corner[2] - point};
}

/// What is known of the distance of a core (a point or a segment) from a triangle.
struct CoreDistance {
  double lower;                 // of the distance
  double upper;                 // likewise
  double along;                 // of the gap along `between`, or 0
  double length;                // of `between`
  Eigen::Vector3d core;         // its closest point
  Eigen::Vector3d on_triangle;  // and that of the triangle
  Eigen::Vector3d between;      // from one to the other
};

/// Of a sphere or capsule. Its center is the origin.
[[nodiscard]] CoreDistance core_distance(const ConvexShape& shape, const Corners& corner) noexcept;

/// What of the triangle closest_point_on_triangle() has found for `point`.
[[nodiscard]] Feature feature_of(const Eigen::Vector3d& point, const Corners& corner,
                                 const Eigen::Vector3d& closest) noexcept;

/// A point of the triangle inside a box that is widened by `widened`: the middle of what the box
/// holds of it. The point closest to the center if it holds nothing.
[[nodiscard]] Eigen::Vector3d point_inside_box(const ConvexShape& box, double widened,
                                               const Corners& corner) noexcept;

}  // namespace boxtree
