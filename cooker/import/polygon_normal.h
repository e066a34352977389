// SPDX-License-Identifier: MIT
// Which way a polygon looks.
#pragma once

#include <span>

#include <Eigen/Core>

namespace boxtree::cooker {

/// Twice the area of a polygon as seen along each axis, whether it is planar or not (Newell's
/// normal). The largest part has the right sign, or is zero where all are: beside corners at 1e38
/// a sum of doubles knows nothing of others at 1e-38. For coordinates up to 2^200 that are
/// multiples of 2^-537. O(n); some ten times slower where doubles do not settle it.
[[nodiscard]] Eigen::Vector3d polygon_normal(std::span<const Eigen::Vector3d> corners);

/// The axis along which it is largest; of equals the last one, then the first.
[[nodiscard]] int dominant_axis(const Eigen::Vector3d& normal);

}  // namespace boxtree::cooker
