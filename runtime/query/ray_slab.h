// SPDX-License-Identifier: MIT
// The slab test of a ray against boxes (Kay and Kajiya, 1986), widened by its own rounding error.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <Eigen/Core>

#include "format/box.h"
#include "runtime/primitive/rounding.h"
#include "runtime/primitive/vector3.h"

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
/// multiplication by a constant are. The largest plane counts as the next power of two: codecs
/// round their root boxes differently, and a hit that is held to the bounds of its triangle must
/// not depend on that.
class RaySlab {
 public:
  /// `origin_reach` and `reach`: largest magnitude of a coordinate of the origin and of any box, on
  /// all axes.
  RaySlab(const Eigen::Vector3d& origin, double origin_reach, const Eigen::Vector3d& direction,
          double reach) noexcept {
    // A zero (or nearly zero) component gets a huge finite reciprocal instead of an infinite one:
    // zero times it is zero, not NaN, so a ray inside or on a slab passes and one outside does not.
    constexpr double kHuge = 0x1p1000;
    const double margin = 8 * kRoundoffF64 * (origin_reach + power_above(reach));
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      const double d = direction[axis];
      near_side_[k] = std::signbit(d) ? 1 : 0;
      inverse_[k] = std::abs(d) < 1 / kHuge ? std::copysign(kHuge, d) : 1 / d;
      // No branch on a sign, here and below: it is as likely as not.
      const double toward = std::copysign(margin, d);
      near_origin_[k] = origin[axis] + toward;
      far_origin_[k] = origin[axis] - toward;
    }
  }
  RaySlab(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double reach) noexcept
      : RaySlab(origin, largest_magnitude(origin), direction, reach) {}

  template <class S>
  [[nodiscard]] SlabInterval intersect(const Box<S>& box) const noexcept {
    SlabInterval interval{-std::numeric_limits<double>::infinity(),
                          std::numeric_limits<double>::infinity()};
    const std::array<const S*, 2> side = {box.low.data(), box.high.data()};
    for (std::size_t k = 0; k < 3; ++k) {
      const double near_plane = side[near_side_[k]][k];
      const double far_plane = side[1 - near_side_[k]][k];
      interval.enter = std::max(interval.enter, (near_plane - near_origin_[k]) * inverse_[k]);
      interval.leave = std::min(interval.leave, (far_plane - far_origin_[k]) * inverse_[k]);
    }
    return interval;
  }

  /// Where the line enters a box; infinity where it misses it, or leaves it before `from`.
  template <class S>
  [[nodiscard]] double key(const Box<S>& box, double from) const noexcept {
    const SlabInterval interval = intersect(box);
    const bool passes = interval.enter <= interval.leave && interval.leave >= from;
    return passes ? interval.enter : std::numeric_limits<double>::infinity();
  }

  /// The least power of two that is not below x; some such for subnormal numbers. Precondition: x
  /// is finite and not negative.
  [[nodiscard]] static double power_above(double x) noexcept {
    constexpr std::uint64_t kMantissa = (std::uint64_t{1} << 52) - 1;
    return std::bit_cast<double>((std::bit_cast<std::uint64_t>(x) + kMantissa) & ~kMantissa);
  }

  /// 1 where the line comes from the high side of an axis, else 0.
  [[nodiscard]] std::size_t near_side(std::size_t axis) const noexcept { return near_side_[axis]; }
  /// 1 / direction, but finite.
  [[nodiscard]] double inverse(std::size_t axis) const noexcept { return inverse_[axis]; }

 private:
  std::array<std::uint32_t, 3> near_side_;
  std::array<double, 3> inverse_;
  std::array<double, 3> near_origin_;
  std::array<double, 3> far_origin_;
};

}  // namespace boxtree
