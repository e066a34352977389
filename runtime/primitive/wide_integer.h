// SPDX-License-Identifier: MIT
// Integers of many words, for products of doubles whose exponents are too far apart for expansions:
// there the error of a product underflows. Slow, and rarely needed.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace boxtree {

/// A multiple of some power of two, in two's complement, the least significant word first. Every
/// result here is wide enough, so nothing is ever cut off.
template <std::size_t Words>
struct WideInteger {
  std::array<std::uint32_t, Words> word{};

  [[nodiscard]] bool is_negative() const noexcept { return (word[Words - 1] >> 31) != 0; }

  [[nodiscard]] int sign() const noexcept {
    if (is_negative()) return -1;
    for (const std::uint32_t w : word) {
      if (w != 0) return 1;
    }
    return 0;
  }

  [[nodiscard]] WideInteger operator-() const noexcept {
    WideInteger result;
    std::uint64_t carry = 1;
    for (std::size_t i = 0; i < Words; ++i) {
      carry += ~word[i];
      result.word[i] = static_cast<std::uint32_t>(carry);
      carry >>= 32;
    }
    return result;
  }

  /// Precondition: the sum fits; the bit below the sign is free in both.
  [[nodiscard]] friend WideInteger operator+(const WideInteger& a, const WideInteger& b) noexcept {
    WideInteger result;
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i < Words; ++i) {
      carry += std::uint64_t{a.word[i]} + b.word[i];
      result.word[i] = static_cast<std::uint32_t>(carry);
      carry >>= 32;
    }
    return result;
  }
  [[nodiscard]] friend WideInteger operator-(const WideInteger& a, const WideInteger& b) noexcept {
    return a + (-b);
  }
};

template <std::size_t M, std::size_t N>
[[nodiscard]] WideInteger<M + N> operator*(const WideInteger<M>& a,
                                           const WideInteger<N>& b) noexcept {
  const WideInteger<M> x = a.is_negative() ? -a : a;
  const WideInteger<N> y = b.is_negative() ? -b : b;
  WideInteger<M + N> result;
  for (std::size_t i = 0; i < M; ++i) {
    if (x.word[i] == 0) continue;
    std::uint64_t carry = 0;
    for (std::size_t j = 0; j < N; ++j) {
      carry += std::uint64_t{x.word[i]} * y.word[j] + result.word[i + j];
      result.word[i + j] = static_cast<std::uint32_t>(carry);
      carry >>= 32;
    }
    result.word[i + N] = static_cast<std::uint32_t>(carry);
  }
  return a.is_negative() != b.is_negative() ? -result : result;
}

/// Words for a difference of two doubles of at most 2^200 (see kMaxCoordinate) in units of 2^-1074,
/// the least double: 1275 bits and a sign.
inline constexpr std::size_t kDifferenceWords = 40;
using WideDifference = WideInteger<kDifferenceWords>;

/// x in units of 2^-1074. Numbers beyond 2^200, which only corrupt bytes lead to, are clamped.
[[nodiscard]] inline WideDifference wide_integer(double x) noexcept {
  constexpr int kLeastExponent = -1074;
  constexpr double kLargest = 0x1p200;
  if (!(std::abs(x) <= kLargest)) x = std::copysign(kLargest, x);
  int exponent = 0;
  const double mantissa = std::frexp(std::abs(x), &exponent);  // below 1
  // Subnormal numbers have fewer bits.
  const int bits = std::min(53, exponent - kLeastExponent);
  WideDifference result;
  if (bits <= 0) return result;  // zero
  const auto whole = static_cast<std::uint64_t>(std::ldexp(mantissa, bits));
  const auto shift = static_cast<std::size_t>(exponent - bits - kLeastExponent);
  const std::uint64_t low = (whole & 0xffffffffu) << (shift % 32);
  const std::uint64_t high = (whole >> 32) << (shift % 32);
  const std::array<std::uint64_t, 3> part{low, (low >> 32) | high, high >> 32};
  for (std::size_t i = 0; i < 3 && shift / 32 + i < kDifferenceWords; ++i) {
    result.word[shift / 32 + i] = static_cast<std::uint32_t>(part[i]);
  }
  return x < 0 ? -result : result;
}

/// a - b in units of 2^-1074.
[[nodiscard]] inline WideDifference wide_difference(double a, double b) noexcept {
  return wide_integer(a) - wide_integer(b);
}

}  // namespace boxtree
