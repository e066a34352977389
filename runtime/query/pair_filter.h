// SPDX-License-Identifier: MIT
// The maps between two trees in single precision: rejects pairs of boxes that are provably apart.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "runtime/primitive/rounding.h"
#include "runtime/query/relative_pose.h"
#include "runtime/tree/bound_tree.h"
#include "runtime/tree/float_range.h"
#include "runtime/walk/traversal.h"

namespace boxtree {

/// x -> linear x + translation, for boxes given by center and half extent: the image has center
/// linear c + translation and half extent |linear| h.
struct FloatMap {
  /// `max_abs`: largest absolute coordinates of x; `target_max_abs`: of the boxes that images are
  /// compared with; `given_error`: of the map itself. No magnitude may exceed `limit`, or
  /// is_in_range is false and the map must not be used.
  FloatMap(const AffineMap& map, const Eigen::Vector3d& max_abs,
           const Eigen::Vector3d& target_max_abs, const Eigen::Vector3d& given_error,
           double limit) noexcept {
    double largest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      double magnitude = std::abs(map.translation[row]);
      for (std::size_t j = 0; j < 3; ++j) {
        const auto column = static_cast<Eigen::Index>(j);
        const double m = map.linear(row, column);
        linear[j][i] = static_cast<float>(m);
        absolute[j][i] = float_above(std::abs(m));
        magnitude += std::abs(m) * max_abs[column];
        largest = std::max(largest, std::abs(m));
      }
      largest = std::max({largest, magnitude, target_max_abs[row], given_error[row]});
      translation[i] = static_cast<float>(map.translation[row]);
      // Each of the three products passes through the rounding of its factors, of the center and of
      // three sums: 8u of the sum of magnitudes, doubled for the half extents; 4u of what the image
      // is compared with, for its own center and half extent and their sums.
      error[i] =
          float_above(16 * kRoundoffF32 * magnitude + 4 * kRoundoffF32 * target_max_abs[row] +
                      given_error[row] + kFloatUnderflow);
    }
    is_in_range = largest <= limit;
  }

  // Columns of three rows, and a fourth of zeros for vectors.
  std::array<std::array<float, 4>, 3> linear{};    // [column][row]
  std::array<std::array<float, 4>, 3> absolute{};  // magnitudes, rounded up
  std::array<float, 4> translation{};
  std::array<float, 4> error{};  // of an image compared with a box, on each axis
  bool is_in_range;
};

/// Two trees in relative pose. Triangles are compared in the first one's space, by heights that are
/// products of three coordinates (float_range.h); the map to the second only moves boxes, with one
/// product per term.
struct PairFilter {
  PairFilter(const BoundTree& first, const BoundTree& second, const RelativePose& pose) noexcept
      : to_first(pose.to_first(), second.max_abs(), first.max_abs(), Eigen::Vector3d::Zero(),
                 kFloatMaxAbs),
        to_second(pose.to_second(), first.max_abs(), second.max_abs(), pose.to_second_error(),
                  kFloatMaxAbs * kFloatMaxAbs) {}

  /// Whether the filter may be used.
  [[nodiscard]] bool is_in_range() const noexcept {
    return to_first.is_in_range && to_second.is_in_range;
  }

  FloatMap to_first;   // of boxes and triangles of the second tree
  FloatMap to_second;  // of boxes of the first tree
};

}  // namespace boxtree
