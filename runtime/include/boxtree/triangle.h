// SPDX-License-Identifier: MIT
// A triangle: three corners in double precision.
#pragma once

#include <array>

#include <Eigen/Core>

namespace boxtree {

/// A triangle in any orthogonal coordinates. Corners may coincide or lie on a line: queries treat
/// such a degenerate triangle as the segment or point that it is.
struct Triangle {
  std::array<Eigen::Vector3d, 3> corner;  ///< Counterclockwise, seen from the front.
};

}  // namespace boxtree
