// SPDX-License-Identifier: MIT
// Unit roundoffs, and the conversions from double to float with a given direction of rounding.
// Every bound on rounding in the runtime is a multiple of these roundoffs; docs/GUARANTEES.md lists
// where each is derived.
#pragma once

#include <bit>
#include <cmath>
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

/// The largest square whose root, rounded, is at most `length`, which is not NaN or negative: a
/// distance that is compared as its square is within a limit exactly if it is so when it is told,
/// unless the distance is subnormal there.
[[nodiscard]] inline double largest_square_within(double length) noexcept {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double square = length * length;
  // Squares that are as far apart as doubles have roots that are half as far: three steps at most,
  // fewer where they underflow.
  while (square < kInfinity && std::sqrt(std::nextafter(square, kInfinity)) <= length) {
    square = std::nextafter(square, kInfinity);
  }
  // Below the square root of the least double, a square may have been rounded up.
  while (std::sqrt(square) > length) square = std::nextafter(square, 0.0);
  return square;
}

}  // namespace boxtree
