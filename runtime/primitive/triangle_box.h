// SPDX-License-Identifier: MIT
// Overlap of a triangle and an axis-aligned box, never missed.
#pragma once

#include <boxtree/runtime/primitive/triangle.h>

namespace boxtree {

/// Whether a triangle and the box [low, high] share a point: separating axes (Akenine-Moller,
/// "Fast 3D Triangle-Box Overlap Testing", 2001) in double precision. Never answers false for
/// shapes that share a point: each axis is widened by the bound of its own rounding error.
/// Precondition: low <= high on every axis.
[[nodiscard]] bool triangle_intersects_box(const Triangle& triangle, const Eigen::Vector3d& low,
                                           const Eigen::Vector3d& high) noexcept;

}  // namespace boxtree
