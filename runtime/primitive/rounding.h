// SPDX-License-Identifier: MIT
// Unit roundoffs, and the conversions from double to float with a given direction of rounding.
// Every bound on rounding in the runtime is a multiple of these roundoffs; docs/GUARANTEES.md lists
// where each is derived.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>

namespace boxtree {

/// Unit roundoffs: an operation rounded to nearest is off by at most this fraction of its result,
/// unless the result is subnormal.
inline constexpr double kRoundoffF32 = 0x1p-24;
inline constexpr double kRoundoffF64 = 0x1p-53;
static_assert(kRoundoffF32 == std::numeric_limits<float>::epsilon() / 2 &&
              kRoundoffF64 == std::numeric_limits<double>::epsilon() / 2);

/// A float that is not below x and, except for x = 0, at most two steps above it; infinity beyond
/// the largest float. Not for NaN.
[[nodiscard]] inline float float_above(double x) noexcept {
  const auto nearest = static_cast<float>(x);
  // No branch: both directions of rounding are equally likely. A zero above x is -0.
  const auto bits = std::bit_cast<std::int32_t>(nearest);
  const std::int32_t is_below = double{nearest} < x ? 1 : 0;
  return std::bit_cast<float>(bits + (bits < 0 ? -is_below : is_below));
}

/// A float that is not above x, likewise.
[[nodiscard]] inline float float_below(double x) noexcept {
  return -float_above(-x);
}

}  // namespace boxtree
