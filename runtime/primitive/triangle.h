// SPDX-License-Identifier: MIT
// The triangle that every leaf predicate takes: three corners in double precision.
#pragma once

#include <array>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace boxtree {

/// A triangle in any orthogonal coordinates. Corners may coincide or lie on a line: the predicates
/// treat such a degenerate triangle as the segment or point that it is.
struct Triangle {
  std::array<Eigen::Vector3d, 3> corner;
};

/// Whether the triangle's normal, computed in double, is zero: a segment, a point, or too thin to
/// have an area that double resolves.
[[nodiscard]] inline bool is_degenerate(const Triangle& triangle) noexcept {
  return (triangle.corner[1] - triangle.corner[0])
      .cross(triangle.corner[2] - triangle.corner[0])
      .isZero(0);
}

}  // namespace boxtree
