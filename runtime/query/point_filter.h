// SPDX-License-Identifier: MIT
// A point in single precision: bounds of its squared distance to boxes and triangles.
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "runtime/primitive/rounding.h"
#include "runtime/walk/traversal.h"

namespace boxtree {

/// `error` bounds, on every axis, how far a distance can be off: the point and a corner rounded to
/// float, and their difference; with u = 2^-24 below 4u (|point| + max_abs). The point is widened
/// to a box of that size, so that differences are bounds; above() and below() cover what squares
/// and sums lose after that.
struct PointFilter {
  /// `max_abs`: the largest absolute coordinate of the tree's boxes.
  PointFilter(double max_abs, const Eigen::Vector3d& point) noexcept {
    const double bound = 4 * kRoundoffF32 * (point.cwiseAbs().maxCoeff() + max_abs) +
                         double{std::numeric_limits<float>::min()};
    error = float_above(bound);
    for (std::size_t k = 0; k < 3; ++k) {
      const double p = point[static_cast<Eigen::Index>(k)];
      center[k] = static_cast<float>(p);
      low[k] = float_below(p - bound);
      high[k] = float_above(p + bound);
    }
  }

  /// Whether single precision resolves the parts of a tree from the point: not from far away.
  [[nodiscard]] static bool is_near(double max_abs, const Eigen::Vector3d& point) noexcept {
    return point.cwiseAbs().maxCoeff() <= 64 * max_abs;
  }

  /// A float that a computed lower bound of a squared distance does not exceed if the squared
  /// distance does not exceed `squared`; three products and two sums lose less than 8u of it.
  [[nodiscard]] static float above(double squared) noexcept {
    return float_above(squared) * static_cast<float>(1 + 16 * kRoundoffF32) +
           std::numeric_limits<float>::min();
  }
  /// The same for upper bounds.
  [[nodiscard]] static float below(double squared) noexcept {
    return float_below(squared) * static_cast<float>(1 - 16 * kRoundoffF32) -
           std::numeric_limits<float>::min();
  }

  float error;
  std::array<float, 3> center;
  std::array<float, 3> low;
  std::array<float, 3> high;
};

}  // namespace boxtree
