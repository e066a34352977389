// SPDX-License-Identifier: MIT
// How deep a point is below a surface of which some faces are given.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "tests/stiff/shape.h"

namespace boxtree::stiff {

struct WorldTriangle {
  std::array<Eigen::Vector3d, 3> corner;
  Eigen::Vector3d normal;
};

/// Triangles with an area of some faces, placed in the world. `pose` may be null: object space.
void place(const Shape& shape, std::span<const std::uint32_t> faces, const Pose* pose,
           std::vector<WorldTriangle>& out);

struct Depth {
  double depth;
  Eigen::Vector3d normal;  // from the point to the surface
  bool at_edge;
};

/// The depth below the nearest of the triangles, the first of several; nothing when the point is
/// not below it, or farther than `limit`.
[[nodiscard]] std::optional<Depth> depth_of(const Eigen::Vector3d& point,
                                            std::span<const WorldTriangle> triangles, double limit);

}  // namespace boxtree::stiff
