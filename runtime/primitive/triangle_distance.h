// SPDX-License-Identifier: MIT
// Distance of two triangles, with bounds.
#pragma once

#include "runtime/primitive/triangle.h"

namespace boxtree {

/// Bounds of the distance between two triangles, and the points that the upper one belongs to.
struct TriangleDistance {
  double lower;
  double upper;
  Eigen::Vector3d first;   // on the first triangle, up to rounding
  Eigen::Vector3d second;  // on the second one
};

/// lower <= distance <= upper always, rounding included: the lower bound is a gap between the two
/// along a direction, the upper one the distance of two of their points. They are some 2^-46 of the
/// largest coordinate apart, more where a triangle is so thin that its normal drowns in rounding:
/// take triangles near the origin. `lower` is 0 where the two cannot be told apart that way;
/// whether they touch is for triangles_intersect to say. Degenerate triangles are the segments or
/// points that they are. Symmetric but for rounding.
[[nodiscard]] TriangleDistance triangle_distance(const Triangle& p, const Triangle& q) noexcept;

}  // namespace boxtree
