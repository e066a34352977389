// SPDX-License-Identifier: MIT
// Closest point: the point of the surface nearest to a given one.
#pragma once

#include <limits>
#include <optional>

#include <boxtree/runtime/query/types.h>

namespace boxtree {

struct ClosestPoint {
  Eigen::Vector3d point;  // object space
  double distance;        // object space
  FaceRef face;
  std::uint32_t triangle;  // 0, or 1 for the second half (0,2,3) of a quad
};

/// The nearest point of the tree's surface within `max_distance` of `point` (object space), or
/// nothing. Of several faces at the same distance the one with the smallest id (order, if the file
/// has no ids). Errors: kInvalidQuery (NaN or infinite point, NaN or negative distance) and the
/// codes of corrupt bytes as for closest_hit. Never allocates.
Result<std::optional<ClosestPoint>> closest_point(
    const Tree& tree, const Eigen::Vector3d& point,
    double max_distance = std::numeric_limits<double>::infinity());

}  // namespace boxtree
