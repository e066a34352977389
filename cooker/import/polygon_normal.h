// SPDX-License-Identifier: MIT
// The normal of a polygon.
#pragma once

#include <span>

#include <Eigen/Core>

namespace boxtree::cooker {

/// Twice the area of a polygon as seen along each axis, for planar and other polygons (Newell's
/// normal). The largest component has the right sign, or is zero if all are: beside corners at 1e38
/// a sum of doubles loses others at 1e-38. For coordinates up to 2^200 that are multiples of
/// 2^-537. O(n); about ten times slower if doubles do not decide the sign.
[[nodiscard]] Eigen::Vector3d polygon_normal(std::span<const Eigen::Vector3d> corners);

/// The axis of the largest component; among equal ones the last axis, then the first.
[[nodiscard]] int dominant_axis(const Eigen::Vector3d& normal);

}  // namespace boxtree::cooker
