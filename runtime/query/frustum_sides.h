// SPDX-License-Identifier: MIT
// The sides of a frustum in the space of what is compared with them: boxes, and triangles.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include <boxtree/overlap.h>

#include "format/box.h"
#include "runtime/primitive/rounding.h"
#include "runtime/primitive/triangle.h"
#include "runtime/primitive/vector3.h"

namespace boxtree {

/// A half space, widened: normal . x + offset >= 0. Sums are monotone in each coordinate, rounded
/// or not, so that a box passes if any point of it does.
struct FrustumSide {
  Eigen::Vector3d normal;
  double offset;

  [[nodiscard]] double at(const Eigen::Vector3d& x) const noexcept {
    return dot(normal, x) + offset;
  }
  /// The largest and the smallest value in a box.
  template <class S>
  [[nodiscard]] double highest(const Box<S>& box) const noexcept {
    return at(corner_of(box, true));
  }
  template <class S>
  [[nodiscard]] double lowest(const Box<S>& box) const noexcept {
    return at(corner_of(box, false));
  }

 private:
  template <class S>
  [[nodiscard]] Eigen::Vector3d corner_of(const Box<S>& box, bool highest) const noexcept {
    Eigen::Vector3d corner;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      corner[axis] = (normal[axis] >= 0) == highest ? box.high[k] : box.low[k];
    }
    return corner;
  }
};

struct FrustumSides {
  /// By how much offsets are widened, of the sum of magnitudes of the offset and of the products of
  /// normal and coordinates. Let u = 2^-53, s that sum. A value is off by at most 8 u s, where a
  /// cut has rounded the corners by 6 u of the largest coordinate each of six times: 44 u s.
  static constexpr double kError = 64 * kRoundoffF64;

  std::array<FrustumSide, 6> side;

  template <class S>
  [[nodiscard]] bool overlaps(const Box<S>& box) const noexcept {
    bool outside = false;
    for (const FrustumSide& each : side) outside = outside || each.highest(box) < 0;
    return !outside;
  }
  [[nodiscard]] bool touches(const Triangle& triangle) const noexcept;
};

/// Whether all planes are finite.
[[nodiscard]] inline bool is_finite(const Frustum& frustum) noexcept {
  bool all = true;
  for (const Frustum::Plane& plane : frustum.planes) {
    all = all && std::isfinite(largest_magnitude(plane.head<3>())) && std::isfinite(plane[3]);
  }
  return all;
}

}  // namespace boxtree
