// SPDX-License-Identifier: MIT
// What one operation can lose, and the way from double to float that loses no answer. Every bound
// on rounding in the runtime is a multiple of these; docs/GUARANTEES.md lists where each is
// derived.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>

namespace boxtree {

/// Unit roundoffs: an operation to nearest is off by at most this share of its result, unless that
/// is subnormal.
inline constexpr double kRoundoffF32 = 0x1p-24;
inline constexpr double kRoundoffF64 = 0x1p-53;
static_assert(kRoundoffF32 == std::numeric_limits<float>::epsilon() / 2 &&
              kRoundoffF64 == std::numeric_limits<double>::epsilon() / 2);

/// A float that is not below x and, but for x = 0, at most two steps above it; infinity beyond the
/// largest. Not for NaN.
[[nodiscard]] inline float float_above(double x) noexcept {
  const auto nearest = static_cast<float>(x);
  // No branch: which way a number was rounded is as likely as not. Zero is -0 where it is above x.
  const auto bits = std::bit_cast<std::int32_t>(nearest);
  const std::int32_t is_below = double{nearest} < x ? 1 : 0;
  return std::bit_cast<float>(bits + (bits < 0 ? -is_below : is_below));
}

/// A float that is not above x, likewise.
[[nodiscard]] inline float float_below(double x) noexcept {
  return -float_above(-x);
}

}  // namespace boxtree
