// SPDX-License-Identifier: MIT
// Poses as people write them: translation, rotation and scale, or twelve numbers.
#pragma once

#include <Eigen/Core>

#include "cooker/scene/profile_fields.h"

namespace boxtree::cooker {

/// Reads keys translation, rotation or axis and degrees, scale, or matrix. Wrong ones, and poses
/// that are not invertible, are complained of; the result is the identity then.
[[nodiscard]] Pose read_pose(Fields& fields);

/// Rotation about an axis that need not have length 1. The same bits on every machine; exact for
/// multiples of 90 degrees about an axis of coordinates. Precondition: a finite axis other than 0.
[[nodiscard]] Eigen::Matrix3d rotation_about(const Eigen::Vector3d& axis, double degrees) noexcept;

/// Rotation by a quaternion, of which x, y and z come first, divided by its length.
[[nodiscard]] Eigen::Matrix3d rotation_of(const Eigen::Vector4d& quaternion) noexcept;

/// Whether the determinant is larger than what rounding can make of it. Independent of the unit.
[[nodiscard]] bool is_invertible(const Eigen::Matrix3d& linear) noexcept;

}  // namespace boxtree::cooker
