// SPDX-License-Identifier: MIT
// The unit normal of a triangle, however thin, and what a pose makes of it.
#pragma once

#include <Eigen/Core>

#include <boxtree/triangle.h>

namespace boxtree {

/// The direction from which the corners are seen counterclockwise, of length 1. Each coordinate is
/// within 2^-47 of the true one, if the edges at the first corner are differences that double
/// holds, as those of f32 meshes are, or the sine of their angle is above 2^-50. Zero for a
/// triangle without area, but for rounding where double does not hold them. Precondition:
/// coordinates of at most 2^200 (kMaxCoordinate).
[[nodiscard]] Eigen::Vector3d unit_normal(const Triangle& triangle) noexcept;

/// The unit normal of a surface after `linear`, the linear part of a pose, has been applied to it:
/// on the side that the pose carries the old one to, mirrors included. Zero for zero.
[[nodiscard]] Eigen::Vector3d placed_normal(const Eigen::Matrix3d& linear,
                                            const Eigen::Vector3d& normal) noexcept;

}  // namespace boxtree
