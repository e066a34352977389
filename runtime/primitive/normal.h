// SPDX-License-Identifier: MIT
// The unit normal of a triangle, however thin, and what a pose makes of it.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include <boxtree/triangle.h>

namespace boxtree {

/// The unit vector to the side from which the corners are counterclockwise. Each coordinate is
/// within 2^-47 of the exact one if the edges at the first corner are exact in double, as in f32
/// meshes, or the sine of their angle is above 2^-50. Zero for a triangle without area, up to
/// rounding if its edges are not exact in double. Precondition: coordinates of at most 2^200
/// (kMaxCoordinate).
[[nodiscard]] Eigen::Vector3d unit_normal(const Triangle& triangle) noexcept;

/// Some unit vector across `along`, which may be zero.
[[nodiscard]] Eigen::Vector3d unit_across(const Eigen::Vector3d& along) noexcept;

/// The unit normal of a surface after `linear`, the linear part of a pose, has been applied to it:
/// on the side to which the pose maps the old one, mirrors included. Zero for zero.
[[nodiscard]] Eigen::Vector3d placed_normal(const Eigen::Matrix3d& linear,
                                            const Eigen::Vector3d& normal) noexcept;

/// Whether it turns the order of corners over.
[[nodiscard]] bool is_mirror(const Eigen::Matrix3d& linear) noexcept;

// Below, what it is computed by, for those who do the same by vectors: sphere_contacts-inl.h.

/// Twice the bias of a double's exponent: that of a power of two less that of a number is the
/// exponent of what scales the number into [1, 2).
inline constexpr std::uint64_t kTwiceBias = 2046;
/// Corners whose cross product has no coordinate above this part of the product of their edges are
/// nearly collinear.
inline constexpr double kNearlyCollinear = 0x1p-3;

}  // namespace boxtree
