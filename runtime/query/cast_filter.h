// SPDX-License-Identifier: MIT
// A cast in single precision: the line of the shape's center against boxes that are widened by the
// shape.
#pragma once

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

/// One of the axes, on its own: projections on it overlap from their distance ahead, less `extent`,
/// times `per_ahead` on, until their distance behind, and `extent`, times `per_behind`. Where it
/// hardly moves along it, what is behind, by more than `extent`, may come back after that times
/// `per_return`.
struct AxisMotion {
  bool is_against;   // whether the shape moves against it
  float extent;      // half, of the whole shape, and what projections of boxes are off
  float per_ahead;   // 1 / speed, rounded down
  float per_behind;  // 1 / speed, rounded up; 0 where it hardly moves along it
  float per_return;  // 1 / what the speed is off, rounded down
};

/// An InnerShape, rounded inward.
struct InnerFloats {
  bool is_known;  // if false, nothing is surely inside, or it does not matter
  bool is_box;
  float radius;  // unless it is a box
  float ratio, less;
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
  explicit CastFilter(const CastQuery& query) noexcept;

  float radius;
  float direction[3];
  ConvexAxes core;
  AxisMotion motion[3];
  InnerFloats inside;

 private:
  [[nodiscard]] static InnerFloats inside_of(const CastQuery& query) noexcept;
  [[nodiscard]] AxisMotion motion_along(const float (&v)[3]) const noexcept;
};

}  // namespace boxtree
