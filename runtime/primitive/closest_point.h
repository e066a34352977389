// SPDX-License-Identifier: MIT
// The closest point of a triangle.
#pragma once

#include <cstdint>

#include "runtime/primitive/triangle.h"

namespace boxtree {

/// The point of a triangle closest to `point`. For degenerate triangles the closest point of the
/// segment or point that is left. Its distance exceeds the exact one by at most a few units in the
/// last place of the largest coordinate involved, whatever the shape of the triangle, and it is off
/// the triangle by no more than that. Never NaN.
[[nodiscard]] Eigen::Vector3d closest_point_on_triangle(const Eigen::Vector3d& point,
                                                        const Triangle& triangle) noexcept;

/// Of which corners the point that closest_point_on_triangle() found is a mean, bit i: corner i.
/// One on a corner, two on an edge, all inside; of a degenerate triangle at most two. `closest`:
/// what that returned.
[[nodiscard]] std::uint32_t closest_corners(const Eigen::Vector3d& point, const Triangle& triangle,
                                            const Eigen::Vector3d& closest) noexcept;

// Below, what it is computed by, for those who do the same by vectors: sphere_contacts-inl.h.

/// Squares below this could lose significant bits to underflow: the smallest normal number is
/// 2^-122 of it.
inline constexpr double kShortestSquare = 0x1p-900;

/// Triangles whose edges and height differ by factors below 2^5, seen from less than 2^20 edges
/// away, have weights that are off by less than 2^40 u.
inline constexpr double kThin = 0x1p-10;
inline constexpr double kFar = 0x1p40;
inline constexpr double kWeightError = 0x1p-13;

}  // namespace boxtree
