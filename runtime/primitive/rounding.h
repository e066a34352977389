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
  const auto neighbour = [](double x, int steps) {  // of a positive number
    return std::bit_cast<double>(std::bit_cast<std::int64_t>(x) + steps);
  };
  double square = length * length;
  if (square == std::numeric_limits<double>::infinity()) return square;
  // Roots below (length + ulp / 2)^2 are rounded to the length: that is 0.7 to 1.5 units in the
  // last place of the square above it, which is itself rounded by half of one, so one or two steps.
  while (std::sqrt(neighbour(square, 1)) <= length) square = neighbour(square, 1);
  // The root of a square is the length again, unless the square is subnormal and was rounded up.
  if (square < std::numeric_limits<double>::min()) {
    while (std::sqrt(square) > length) square = neighbour(square, -1);
  }
  return square;
}

}  // namespace boxtree
