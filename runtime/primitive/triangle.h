// SPDX-License-Identifier: MIT
// Properties of a triangle that leaf predicates use.
#pragma once

#include <Eigen/Geometry>

#include <boxtree/triangle.h>

namespace boxtree {

/// Whether the triangle's normal, computed in double, is zero: a segment, a point, or too thin to
/// have an area that double resolves.
[[nodiscard]] inline bool is_degenerate(const Triangle& triangle) noexcept {
  return (triangle.corner[1] - triangle.corner[0])
      .cross(triangle.corner[2] - triangle.corner[0])
      .isZero(0);
}

}  // namespace boxtree
