// SPDX-License-Identifier: MIT
// Distance of two triangles, with bounds.
#pragma once

#include "runtime/primitive/triangle.h"

namespace boxtree {

/// Bounds of the distance between two triangles, and the points at the upper bound.
struct TriangleDistance {
  double lower;
  double upper;
  Eigen::Vector3d first;   // on the first triangle, up to rounding
  Eigen::Vector3d second;  // on the second one
  Eigen::Vector3d apart;   // the direction whose gap `lower` is, of any length
};

/// lower <= distance <= upper always, rounding included: the lower bound is a gap between the two
/// along a direction, the upper one the distance of two of their points. They differ by about 2^-46
/// of the largest coordinate, or more where a triangle is so thin that rounding dominates its
/// normal, so move the triangles near the origin first. `lower` is 0 where no gap is found;
/// triangles_intersect decides whether they touch. Degenerate triangles are treated as segments or
/// points. Symmetric except for rounding.
[[nodiscard]] TriangleDistance triangle_distance(const Triangle& p, const Triangle& q) noexcept;

/// The same of a segment and a triangle, in half the time.
[[nodiscard]] TriangleDistance segment_distance(const Eigen::Vector3d& from,
                                                const Eigen::Vector3d& to,
                                                const Triangle& q) noexcept;

/// Likewise, without a bound below: `lower` is 0, `apart` zero. If the segment pierces the
/// triangle, the points need not be close to each other.
[[nodiscard]] TriangleDistance segment_closest_points(const Eigen::Vector3d& from,
                                                      const Eigen::Vector3d& to,
                                                      const Triangle& q) noexcept;

/// Likewise, of an end of the segment (the first or the last) or of the segment and edge `part` - 2
/// of the triangle: an upper bound that is the distance if the closest points are there.
[[nodiscard]] TriangleDistance closest_points_of_part(const Eigen::Vector3d& from,
                                                      const Eigen::Vector3d& to, const Triangle& q,
                                                      std::size_t part) noexcept;

}  // namespace boxtree
