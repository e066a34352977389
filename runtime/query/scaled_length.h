// SPDX-License-Identifier: MIT
// Lengths times powers of two: exact except at the limits of double, and there a bound.
#pragma once

#include <cmath>
#include <limits>

namespace boxtree {

/// Squares of shorter lengths may underflow, so bounds are widened by this.
inline constexpr double kLengthUnderflow = 0x1p-500;

/// A lower bound of 2^exponent * length; infinite only if the length is.
[[nodiscard]] inline double scaled_below(double length, int exponent) noexcept {
  const double result = std::ldexp(length, exponent);
  const bool is_infinite = length == std::numeric_limits<double>::infinity();
  return is_infinite || std::ldexp(result, -exponent) <= length ? result
                                                                : std::nextafter(result, 0.0);
}

/// An upper bound of 2^exponent * length.
[[nodiscard]] inline double scaled_above(double length, int exponent) noexcept {
  const double result = std::ldexp(length, exponent);
  return std::ldexp(result, -exponent) >= length
             ? result
             : std::nextafter(result, std::numeric_limits<double>::infinity());
}

}  // namespace boxtree
