// SPDX-License-Identifier: MIT
// IEEE 754 binary16 ("f16") by bit operations: the same value on every machine, no F16C needed.
#pragma once

#include <bit>
#include <cstdint>

namespace boxtree {

/// The value of an f16 bit pattern, exact.
[[nodiscard]] constexpr float half_to_float(std::uint16_t half) noexcept {
  const std::uint32_t sign = (half & 0x8000u) << 16;
  const std::uint32_t exponent = (half >> 10) & 0x1fu;
  const std::uint32_t mantissa = half & 0x3ffu;
  if (exponent == 0) {
    // Zero or subnormal: mantissa * 2^-24, which f32 holds as a normal number.
    const float magnitude = static_cast<float>(mantissa) * 0x1p-24f;
    return sign != 0 ? -magnitude : magnitude;
  }
  if (exponent == 0x1f) return std::bit_cast<float>(sign | 0x7f800000u | (mantissa << 13));
  return std::bit_cast<float>(sign | ((exponent + 112) << 23) | (mantissa << 13));
}

/// The largest f16 not above `value`: rounded toward zero, saturating at 65504, so that a cut never
/// takes away more than was requested. Precondition: value >= 0 and not NaN.
[[nodiscard]] constexpr std::uint16_t half_toward_zero(float value) noexcept {
  if (value >= 65504.0f) return 0x7bff;
  if (value < 0x1p-14f) return static_cast<std::uint16_t>(value * 0x1p24f);  // subnormal: truncates
  const auto bits = std::bit_cast<std::uint32_t>(value);
  return static_cast<std::uint16_t>((bits >> 13) - (112u << 10));
}

}  // namespace boxtree
