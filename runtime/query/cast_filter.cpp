// SPDX-License-Identifier: MIT
// A cast, rounded to single precision.
#include "runtime/query/cast_filter.h"

#include <algorithm>
#include <cmath>

namespace boxtree {

CastFilter::CastFilter(const CastQuery& query) noexcept
    : RayBoxFilter(
          query.slab, query.origin, query.direction, std::max(query.enter, query.t_min),
          rounding(query.near) + given_away(query.origin_max_abs, query.near) + query.shape.error) {
  widen(query.extent);
  const ConvexShape& shape = query.shape;
  radius = float_above(shape.radius);
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
  inside = inside_of(query);
}

// A hull is not looked into, and what is round has no inside where its radius rounds to nothing.
InnerFloats CastFilter::inside_of(const CastQuery& query) noexcept {
  InnerFloats out{};
  if (query.wanted != CastQuery::Wanted::kFaces || query.moving.shape.hull != nullptr) return out;
  const InnerShape inside =
      query.placed != nullptr ? query.placed->inside : InnerShape{query.shape.radius};
  constexpr double kDown = 1 - 8 * kRoundoffF32;
  out.is_box = query.moving.is_box();
  out.radius = static_cast<float>(inside.radius * kDown);
  out.ratio = float_above(inside.ratio);
  out.less = float_above(inside.less);
  out.is_known = out.is_box ? inside.radius >= 0 : out.radius > 0;
  return out;
}

// Along a vector, which is rounded no further. u = 2^-24.
AxisMotion CastFilter::motion_along(const float (&v)[3]) const noexcept {
  double size = 0, along = 0, half = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    size += std::abs(double{v[k]});
    along += double{v[k]} * direction[k];
  }
  for (std::uint32_t i = 0; i < core.count; ++i) {
    double projected = 0;
    for (std::size_t k = 0; k < 3; ++k) projected += double{v[k]} * core.axis[i][k];
    half += std::abs(projected) * core.half[i];
  }
  // More than the speed may be off, and quotients by it round.
  constexpr double kError = 16 * kRoundoffF32;
  const double speed = std::abs(along), doubt = kError * size;
  AxisMotion out;
  out.is_against = along < 0;
  out.extent = float_above(half + radius * size + 3 * size * error);
  out.per_ahead = static_cast<float>((1 - kError) / (speed + doubt));
  out.per_behind = speed > 2 * doubt ? static_cast<float>((1 + kError) / (speed - doubt)) : 0;
  out.per_return = static_cast<float>((1 - kError) / doubt);
  return out;
}

}  // namespace boxtree
