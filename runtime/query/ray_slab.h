// SPDX-License-Identifier: MIT
// The slab test of a ray against boxes (Kay and Kajiya, 1986), widened by its own rounding error.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <Eigen/Core>

#include <boxtree/format/box.h>

namespace boxtree {

/// Where a line enters and leaves a box; empty when enter > leave.
struct SlabInterval {
  double enter;
  double leave;
};

/// One ray in tree space, prepared for many boxes.
///
/// Error bound: a plane's parameter is fl(fl(plane - origin) / direction) with a reciprocal rounded
/// once, so its error is at most 3u |plane - origin| in space, and the origin itself was rounded by
/// at most u |origin| when it came to tree space. The leaf test shears coordinates by distances
/// along the main axis, so its errors on one axis grow with the extent on another. `margin` = 8u
/// (|origin| + largest |plane|), both over all axes, covers the sum. It moves each plane outward by
/// moving the origin, which costs nothing per box and keeps the test monotone: subtraction and
/// multiplication by a constant are.
class RaySlab {
 public:
  /// `reach`: largest magnitude of any box coordinate, on each axis.
  RaySlab(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
          const Eigen::Vector3d& reach) noexcept {
    // A zero (or nearly zero) component gets a huge finite reciprocal instead of an infinite one:
    // zero times it is zero, not NaN, so a ray inside or on a slab passes and one outside does not.
    constexpr double kHuge = 0x1p1000;
    constexpr double kUnitRoundoff = std::numeric_limits<double>::epsilon() / 2;
    const double margin = 8 * kUnitRoundoff * (origin.cwiseAbs().maxCoeff() + reach.maxCoeff());
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      const double d = direction[axis];
      forward_[k] = !std::signbit(d);
      inverse_[k] = std::abs(d) < 1 / kHuge ? (forward_[k] ? kHuge : -kHuge) : 1 / d;
      const double before = origin[axis] + margin;
      const double after = origin[axis] - margin;
      near_origin_[k] = forward_[k] ? before : after;
      far_origin_[k] = forward_[k] ? after : before;
    }
  }

  template <class S>
  [[nodiscard]] SlabInterval intersect(const Box<S>& box) const noexcept {
    SlabInterval interval{-std::numeric_limits<double>::infinity(),
                          std::numeric_limits<double>::infinity()};
    for (std::size_t k = 0; k < 3; ++k) {
      const double near_plane = forward_[k] ? box.low[k] : box.high[k];
      const double far_plane = forward_[k] ? box.high[k] : box.low[k];
      interval.enter = std::max(interval.enter, (near_plane - near_origin_[k]) * inverse_[k]);
      interval.leave = std::min(interval.leave, (far_plane - far_origin_[k]) * inverse_[k]);
    }
    return interval;
  }

 private:
  std::array<bool, 3> forward_;
  std::array<double, 3> inverse_;
  std::array<double, 3> near_origin_;
  std::array<double, 3> far_origin_;
};

}  // namespace boxtree
