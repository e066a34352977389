// SPDX-License-Identifier: MIT
// From double to float, away from the answer that must not be lost.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>

namespace boxtree {

/// A float that is not below x and, but for x = 0, at most two steps above it; infinity beyond the
/// largest. Not for NaN.
[[nodiscard]] inline float float_above(double x) noexcept {
  const auto nearest = static_cast<float>(x);
  if (double{nearest} >= x) return nearest;
  const auto bits = std::bit_cast<std::uint32_t>(nearest);
  if (nearest == 0) return std::numeric_limits<float>::denorm_min();
  return std::bit_cast<float>(nearest > 0 ? bits + 1 : bits - 1);
}

/// A float that is not above x, likewise.
[[nodiscard]] inline float float_below(double x) noexcept {
  return -float_above(-x);
}

}  // namespace boxtree
