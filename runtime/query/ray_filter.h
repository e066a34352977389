// SPDX-License-Identifier: MIT
// A ray in single precision: rejects boxes and triangles that the ray provably misses, so that the
// exact tests in double see few. Only those tests accept a hit.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "runtime/primitive/rounding.h"
#include "runtime/query/ray_query.h"

namespace boxtree {

/// A ray against boxes. It is re-based where it enters the root box, so that errors grow with the
/// tree and not with the distance of the ray's origin: parameter s of the filter is parameter start
/// + s of the query. Boxes are widened by `error` on every side, which bounds, on every axis, how
/// far a coordinate relative to the ray can be off.
struct RayBoxFilter {
  /// Of the reciprocals: not so large that a plane's parameter overflows, but large enough that a
  /// ray parallel to a slab, and inside it by at least `error`, leaves it beyond the root box.
  static constexpr double kLargestInverse = 0x1p60;
  /// See given_away().
  static constexpr double kGivenAway = 128 * kRoundoffF64;

  RayBoxFilter() noexcept = default;  // unspecified
  /// `slab`: of the same ray; its direction is scaled as in RayQuery. `bound`: of the error.
  RayBoxFilter(const RaySlab& slab, const AxisLanes& query_origin, const AxisLanes& direction,
               double query_start, double bound) noexcept
      : start(query_start), error(float_above(bound)) {
    // One loop per operation, so that each is vectorised.
    AxisLanes from, within = slab.inverse();
    for (std::size_t k = 0; k < AxisLanes::kCount; ++k) {
      from[k] = query_origin[k] + start * direction[k];
    }
    clamp_magnitudes(within, kLargestInverse);
    for (std::size_t k = 0; k < AxisLanes::kCount; ++k) origin[k] = static_cast<float>(from[k]);
    for (std::size_t k = 0; k < AxisLanes::kCount; ++k) inverse[k] = static_cast<float>(within[k]);
    for (std::size_t k = 0; k < AxisLanes::kCount; ++k) {
      margin[k] = error * std::abs(inverse[k]);
      near_high[k] = inverse[k] < 0 ? 1 : 0;
    }
  }

  /// Widens boxes by half the extent of a shape around the ray's point.
  void widen(const Eigen::Vector3d& extent) noexcept {
    // Rounded up twice: the product and the sum.
    constexpr float kUp = static_cast<float>(1 + 8 * kRoundoffF32);
    for (std::size_t k = 0; k < AxisLanes::kCount; ++k) {
      const double half = extent[static_cast<Eigen::Index>(std::min<std::size_t>(k, 2))];
      margin[k] = (margin[k] + float_above(half) * std::abs(inverse[k])) * kUp;
    }
  }

  /// What a re-based ray, and planes at most `max_abs` away, lose in single precision. Let u =
  /// 2^-24 and M = 2 max_abs: no extent and no distance of two points in the root box is larger,
  /// and the ray enters inside that box up to given_away(). 16u M for origin and direction (moved,
  /// rounded to float), for the distance of a plane or corner from the origin, its product with a
  /// reciprocal that was rounded twice, and the sums after it. And 8u M for each of `levels` whose
  /// planes are computed from those of their parents.
  [[nodiscard]] static double rounding(double max_abs, std::uint32_t levels = 0) noexcept {
    return (16 + 8 * levels) * (kRoundoffF32 * (2 * max_abs)) +
           double{std::numeric_limits<float>::min()};
  }
  /// By how much the query's own tests widen boxes, see RaySlab: eight times its margin.
  [[nodiscard]] static double given_away(double origin_max_abs, double max_abs) noexcept {
    return kGivenAway * (origin_max_abs + max_abs);
  }

  /// The largest parameter of the filter that a hit not beyond `t` can have.
  [[nodiscard]] float bound(double t) const noexcept {
    return float_above(std::max(0.0, t - start)) * static_cast<float>(1 + 8 * kRoundoffF32) +
           4 * error;
  }

  double start;
  float error;
  // One number per axis, and a copy of the last, as in AxisLanes.
  using Lanes = std::array<float, AxisLanes::kCount>;
  alignas(16) Lanes inverse;
  alignas(16) Lanes margin;  // of a plane's parameter
  alignas(16) Lanes origin;
  // 1 where the ray comes from the high side, else 0.
  alignas(16) std::array<std::uint32_t, AxisLanes::kCount> near_high;
};

/// A ray against one tree: against triangles, and against boxes whose planes are computed along the
/// ray from those of their parents, as decoding does in space. Each way has four roundings per
/// level, three of the extent and one of the distance: 8u M.
struct RayFilter : RayBoxFilter {
  /// Whether single precision resolves the parts of a tree for this ray: not from so far away that
  /// double precision hardly does. Elsewhere `error` is below a thousandth of max_abs, and no
  /// parameter overflows.
  [[nodiscard]] static bool is_near(const RayTest& query) noexcept {
    return query.origin_max_abs <= farthest_origin(query.tree);
  }
  [[nodiscard]] static double farthest_origin(const BoundTree& tree) noexcept {
    return 0x1p30 * tree.largest_abs();
  }

  RayFilter() noexcept = default;  // unspecified

  /// Precondition: is_near(query), which enters the root box.
  explicit RayFilter(const RayTest& query) noexcept : RayFilter(query, query.tree.largest_abs()) {}

  alignas(16) Lanes margins;  // of both planes of an axis
  std::size_t axis_x, axis_y, axis_z;
  float shear_x, shear_y, shear_z;

 private:
  RayFilter(const RayTest& query, double max_abs) noexcept
      : RayBoxFilter(
            query.slab, query.origin, query.direction, std::max(query.enter, query.t_min),
            rounding(max_abs, query.tree.depth()) + given_away(query.origin_max_abs, max_abs)) {
    for (std::size_t k = 0; k < AxisLanes::kCount; ++k) margins[k] = 2 * margin[k];
    axis_x = static_cast<std::size_t>(query.shear.axis_x);
    axis_y = static_cast<std::size_t>(query.shear.axis_y);
    axis_z = static_cast<std::size_t>(query.shear.axis_z);
    shear_x = static_cast<float>(query.shear.shear_x);
    shear_y = static_cast<float>(query.shear.shear_y);
    shear_z = static_cast<float>(query.shear.shear_z);  // at most 2: the direction was scaled
  }
};

/// A ray on a walk of its own, whose exact tests are prepared when the first triangle needs them.
struct FilteredRay {
  const RayFilter& filter;
  double t_max;
  WalkBound& nodes;
  FunctionRef<RayTest&()> prepare;
  RayTest* test = nullptr;  // once it is prepared

  [[nodiscard]] RayTest& prepared() {
    if (test == nullptr) test = &prepare();
    return *test;
  }
};

/// Walks a tree by vectors. Precondition: the tree has wide and float nodes; the ray enters its
/// root box. Errors: those of a walk, and of leaves.
Errc walk_wide(const BoundTree& tree, FilteredRay& ray);

}  // namespace boxtree
