// SPDX-License-Identifier: MIT
// Reads poses of a profile: translation, rotation and scale, or twelve numbers.
#pragma once

#include <Eigen/Core>

#include "cooker/scene/profile_fields.h"

namespace boxtree::cooker {

/// Reads the keys translation, rotation or axis and degrees, scale, or matrix. Invalid values and
/// poses that are not invertible are reported; the result is then the identity.
[[nodiscard]] Pose read_pose(Fields& fields);

/// Rotation about an axis of any length. Same bits on every machine; exact for multiples of 90
/// degrees about a coordinate axis. Precondition: a finite axis other than 0.
[[nodiscard]] Eigen::Matrix3d rotation_about(const Eigen::Vector3d& axis, double degrees) noexcept;

/// Rotation by a quaternion (x, y, z, w), divided by its length.
[[nodiscard]] Eigen::Matrix3d rotation_of(const Eigen::Vector4d& quaternion) noexcept;

/// Whether the determinant is larger than its rounding error. Independent of the unit.
[[nodiscard]] bool is_invertible(const Eigen::Matrix3d& linear) noexcept;

}  // namespace boxtree::cooker
