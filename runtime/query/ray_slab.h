// SPDX-License-Identifier: MIT
// The slab test of a ray against boxes (Kay and Kajiya, 1986), widened by its own rounding error.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <Eigen/Core>

#include "format/box.h"
#include "runtime/primitive/axis_lanes.h"
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
/// multiplication by a constant are. The largest plane is rounded up to a power of two: codecs
/// round their root boxes differently, and a hit that is clamped to the bounds of its triangle must
/// not depend on that.
///
/// No low plane is beyond the high one of its axis, so the line intersects first the plane with the
/// smaller parameter: no sign is needed.
class RaySlab {
 public:
  /// A zero (or nearly zero) component gets a huge finite reciprocal instead of an infinite one:
  /// zero times it is zero, not NaN, so a ray inside or on a slab passes and one outside does not.
  static constexpr double kHuge = 0x1p1000;

  /// `origin_max_abs` and `max_abs`: largest absolute coordinate of the origin and of any box,
  /// on all axes.
  RaySlab(const AxisLanes& origin, double origin_max_abs, const AxisLanes& direction,
          double max_abs) noexcept {
    const double margin = 8 * kRoundoffF64 * (origin_max_abs + power_above(max_abs));
    for (std::size_t k = 0; k < AxisLanes::kCount; ++k) {
      inverse_[k] = 1 / direction[k];
      low_origin_[k] = origin[k] + margin;
      high_origin_[k] = origin[k] - margin;
    }
    clamp_magnitudes(inverse_, kHuge);
  }
  RaySlab(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double max_abs) noexcept
      : RaySlab(AxisLanes(origin), largest_magnitude(origin), AxisLanes(direction), max_abs) {}

  /// From now on, boxes are widened by `extent` on each side: for a shape of that half extent
  /// around the ray's point. Precondition: `max_abs` holds for widened boxes.
  void widen(const AxisLanes& extent) noexcept {
    for (std::size_t k = 0; k < AxisLanes::kCount; ++k) low_origin_[k] += extent[k];
    for (std::size_t k = 0; k < AxisLanes::kCount; ++k) high_origin_[k] -= extent[k];
  }

  template <class S>
  [[nodiscard]] SlabInterval intersect(const Box<S>& box) const noexcept {
    SlabInterval interval{-std::numeric_limits<double>::infinity(),
                          std::numeric_limits<double>::infinity()};
    for (std::size_t k = 0; k < 3; ++k) {
      const double low = (box.low[k] - low_origin_[k]) * inverse_[k];
      const double high = (box.high[k] - high_origin_[k]) * inverse_[k];
      interval.enter = std::max(interval.enter, std::min(low, high));
      interval.leave = std::min(interval.leave, std::max(low, high));
    }
    return interval;
  }
  [[nodiscard]] SlabInterval intersect(const BoxLanes& box) const noexcept {
    AxisLanes near, far;
    for (std::size_t k = 0; k < AxisLanes::kCount; ++k) {
      const double low = (box.low[k] - low_origin_[k]) * inverse_[k];
      const double high = (box.high[k] - high_origin_[k]) * inverse_[k];
      near[k] = std::min(low, high);
      far[k] = std::max(low, high);
    }
    return {std::max(std::max(near[0], near[1]), near[2]),
            std::min(std::min(far[0], far[1]), far[2])};
  }

  /// Where the line enters a box; infinity where it misses it, or leaves it before `from`.
  template <class AnyBox>
  [[nodiscard]] double key(const AnyBox& box, double from) const noexcept {
    const SlabInterval interval = intersect(box);
    const bool passes = interval.enter <= interval.leave && interval.leave >= from;
    return passes ? interval.enter : std::numeric_limits<double>::infinity();
  }

  /// The least power of two that is not below x; for subnormal x it need not be the least.
  /// Precondition: x is finite and not negative.
  [[nodiscard]] static double power_above(double x) noexcept {
    constexpr std::uint64_t kMantissa = (std::uint64_t{1} << 52) - 1;
    return std::bit_cast<double>((std::bit_cast<std::uint64_t>(x) + kMantissa) & ~kMantissa);
  }

  /// 1 / direction, but finite; negative where the line comes from the high side of an axis.
  [[nodiscard]] const AxisLanes& inverse() const noexcept { return inverse_; }

 private:
  AxisLanes inverse_;
  AxisLanes low_origin_;   // the origin for low planes
  AxisLanes high_origin_;  // and for high ones
};

}  // namespace boxtree
