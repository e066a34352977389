// SPDX-License-Identifier: MIT
// Lengths times powers of two: exact but where a double ends, and there on the side requested.
#pragma once

#include <cmath>
#include <limits>

namespace boxtree {

/// Squares of lengths below this are subnormal: bounds are wider by so much.
inline constexpr double kLengthUnderflow = 0x1p-500;

/// At most 2^exponent * length, at which it is infinite only if the length is.
[[nodiscard]] inline double scaled_below(double length, int exponent) noexcept {
  const double result = std::ldexp(length, exponent);
  const bool is_infinite = length == std::numeric_limits<double>::infinity();
  return is_infinite || std::ldexp(result, -exponent) <= length ? result
                                                                : std::nextafter(result, 0.0);
}

/// At least 2^exponent * length.
[[nodiscard]] inline double scaled_above(double length, int exponent) noexcept {
  const double result = std::ldexp(length, exponent);
  return std::ldexp(result, -exponent) >= length
             ? result
             : std::nextafter(result, std::numeric_limits<double>::infinity());
}

}  // namespace boxtree
