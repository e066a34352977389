// SPDX-License-Identifier: MIT
// Overlap of a triangle and an axis-aligned box, exactly.
#pragma once

#include "runtime/primitive/triangle.h"

namespace boxtree {

/// Whether a triangle and the box [low, high] share a point: separating axes (Akenine-Moller,
/// "Fast 3D Triangle-Box Overlap Testing", 2001) with exact signs, for all coordinates up to 2^200.
/// Precondition: low <= high on every axis.
[[nodiscard]] bool triangle_intersects_box(const Triangle& triangle, const Eigen::Vector3d& low,
                                           const Eigen::Vector3d& high) noexcept;

}  // namespace boxtree
