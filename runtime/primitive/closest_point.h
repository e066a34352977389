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

}  // namespace boxtree
