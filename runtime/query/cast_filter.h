// SPDX-License-Identifier: MIT
// A cast in single precision: the line of the shape's center against boxes that are widened by the
// shape.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "runtime/primitive/rounding.h"
#include "runtime/query/cast_query.h"
#include "runtime/query/ray_filter.h"

namespace boxtree {

/// The core of a shape, see ConvexShape.
struct ConvexAxes {
  std::uint32_t count;
  float axis[3][3];  // of length 1
  float half[3];     // rounded up
};

/// One of the axes, on its own: projections on it overlap from their distance ahead, less `reach`,
/// times `per_ahead` on, until their distance behind, and `reach`, times `per_behind`.
struct AxisMotion {
  bool is_against;   // whether the shape moves against it
  float reach;       // of the whole shape, and what projections of boxes are off
  float per_ahead;   // 1 / speed, rounded down
  float per_behind;  // 1 / speed, rounded up; 0 where it hardly moves along it
};

/// Boxes are decoded, and rounded no further; see RayBoxFilter.
struct CastFilter : RayBoxFilter {
  /// Whether single precision resolves the parts of a tree for this cast: not from so far away that
  /// double precision hardly does, nor for a shape so large beside the tree that its size takes the
  /// digits.
  [[nodiscard]] static bool is_near(const CastQuery& query) noexcept {
    const double max_abs = query.tree.largest_abs();
    return query.origin_max_abs <= 0x1p30 * max_abs && query.near <= 0x1p10 * max_abs;
  }

  /// Precondition: is_near(query), which enters the root box.
  explicit CastFilter(const CastQuery& query) noexcept
      : RayBoxFilter(query.slab, query.origin, query.direction, std::max(query.enter, query.t_min),
                     rounding(query.near) + given_away(query.origin_max_abs, query.near)) {
    widen(query.extent);
    const ConvexShape& shape = query.shape;
    radius = float_above(shape.radius);
    outer_radius = float_above(shape.outer_radius());
    for (std::size_t k = 0; k < 3; ++k) {
      direction[k] = query.is_moving ? static_cast<float>(query.direction[k]) : 0.0f;
    }
    core.count = shape.axes;
    for (std::uint32_t i = 0; i < shape.axes; ++i) {
      const double length = std::sqrt(squared_length(shape.axis[i]));
      for (std::size_t k = 0; k < 3; ++k) {
        const double component = shape.axis[i][static_cast<Eigen::Index>(k)];
        core.axis[i][k] = length > 0 ? static_cast<float>(component / length) : 0.0f;
      }
      core.half[i] = float_above(shape.half[i] * length);
    }
    for (std::uint32_t i = 0; i < shape.axes; ++i) motion[i] = motion_along(core.axis[i]);
  }

  float radius;
  float outer_radius;  // of a ball that holds the shape
  float direction[3];
  ConvexAxes core;
  AxisMotion motion[3];

 private:
  // Along a vector, which is rounded no further. u = 2^-24.
  [[nodiscard]] AxisMotion motion_along(const float (&v)[3]) const noexcept {
    double size = 0, along = 0, reach = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      size += std::abs(double{v[k]});
      along += double{v[k]} * direction[k];
    }
    for (std::uint32_t i = 0; i < core.count; ++i) {
      double projected = 0;
      for (std::size_t k = 0; k < 3; ++k) projected += double{v[k]} * core.axis[i][k];
      reach += std::abs(projected) * core.half[i];
    }
    // More than the speed may be off, and quotients by it round.
    constexpr double kError = 16 * kRoundoffF32;
    const double speed = std::abs(along), doubt = kError * size;
    AxisMotion out;
    out.is_against = along < 0;
    out.reach = float_above(reach + radius * size + 3 * size * error);
    out.per_ahead = static_cast<float>((1 - kError) / (speed + doubt));
    out.per_behind = speed > 2 * doubt ? static_cast<float>((1 + kError) / (speed - doubt)) : 0;
    return out;
  }
};

}  // namespace boxtree
