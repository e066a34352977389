// SPDX-License-Identifier: MIT
// The closest point of a triangle.
#pragma once

#include <boxtree/runtime/primitive/triangle.h>

namespace boxtree {

/// The point of a triangle closest to `point`. For degenerate triangles the closest point of the
/// segment or point that is left. Within a few ulp of the coordinates involved, times what the
/// triangle's smallest height makes of them. Never NaN.
[[nodiscard]] Eigen::Vector3d closest_point_on_triangle(const Eigen::Vector3d& point,
                                                        const Triangle& triangle) noexcept;

}  // namespace boxtree
