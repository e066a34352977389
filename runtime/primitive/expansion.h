// SPDX-License-Identifier: MIT
// Exact sums and products of doubles as expansions: unevaluated sums of non-overlapping terms
// (after Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
// Predicates", 1997). Needs round-to-nearest-even and no contraction (-ffp-contract=off).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace boxtree {

/// The exact sum of `size` terms, smallest first, none of them zero, no two sharing a bit position;
/// zero has no terms. `Capacity` bounds the terms an operation can produce, so all memory is on the
/// stack and its size is known at compile time.
template <std::size_t Capacity>
struct Expansion {
  std::size_t size = 0;
  std::array<double, Capacity + 1> term;  // one more: see append_last

  void append(double value) noexcept {
    if (value != 0) term[size++] = value;
  }
  /// Appends the last term of a sum or product. Finite terms fit into Capacity, as the first
  /// rounding error of each is zero. Coordinates of corrupt files may overflow to infinities and
  /// NaN, and then there can be one more.
  void append_last(double value) noexcept {
    append(value);
    size = std::min(size, Capacity);
  }
  /// The last term outweighs all others together, so its sign is the sign of the sum.
  [[nodiscard]] int sign() const noexcept { return size == 0 ? 0 : (term[size - 1] > 0 ? 1 : -1); }
  /// The sum rounded to about one ulp; zero only for zero, and of the right sign.
  [[nodiscard]] double estimate() const noexcept {
    double sum = 0;
    for (std::size_t i = 0; i < size; ++i) sum += term[i];
    return sum;
  }
};

/// A rounded result and its rounding error; their sum is exact.
struct Rounded {
  double value;
  double error;
};

/// a + b, for any order of magnitudes (Knuth).
[[nodiscard]] inline Rounded two_sum(double a, double b) noexcept {
  const double sum = a + b;
  const double b_part = sum - a;
  const double a_part = sum - b_part;
  return {sum, (a - a_part) + (b - b_part)};
}

/// a + b where |a| >= |b| (Dekker).
[[nodiscard]] inline Rounded fast_two_sum(double a, double b) noexcept {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// a * b. Exact as long as the error itself does not underflow: a and b multiples of 2^-537.
[[nodiscard]] inline Rounded two_product(double a, double b) noexcept {
  const double product = a * b;
#ifdef FP_FAST_FMA
  // One instruction where the target has it; the error is exact either way, so results are equal.
  return {product, std::fma(a, b, -product)};
#else
  // Dekker: each factor is split into halves of 26 bits, whose products are exact.
  constexpr double kSplitter = 0x1p27 + 1;
  const double a_scaled = kSplitter * a;
  const double a_high = a_scaled - (a_scaled - a);
  const double a_low = a - a_high;
  const double b_scaled = kSplitter * b;
  const double b_high = b_scaled - (b_scaled - b);
  const double b_low = b - b_high;
  const double high_left = product - a_high * b_high;
  const double middle_left = (high_left - a_low * b_high) - a_high * b_low;
  return {product, a_low * b_low - middle_left};
#endif
}

/// A power of two that brings the largest magnitude among exact operands close to 2^200, where the
/// bits of a product of three stay far from underflow and its value far from overflow. For
/// magnitudes up to 2^200 it only scales up, which is exact and keeps signs.
[[nodiscard]] inline double safe_scale(double largest) noexcept {
  constexpr int kTargetExponent = 200;
  constexpr int kMostExponent = 1000;  // 2^1000 is finite, and so is its product with 2^-800
  if (largest == 0) return 1;
  return std::ldexp(1.0, std::clamp(kTargetExponent - std::ilogb(largest), 0, kMostExponent));
}

[[nodiscard]] inline Expansion<2> expansion_of(const Rounded& rounded) noexcept {
  Expansion<2> result;
  result.append(rounded.error);
  result.append(rounded.value);
  return result;
}

[[nodiscard]] inline Expansion<2> exact_difference(double a, double b) noexcept {
  return expansion_of(two_sum(a, -b));
}

[[nodiscard]] inline Expansion<2> exact_product(double a, double b) noexcept {
  return expansion_of(two_product(a, b));
}

/// e + f: the terms of both are merged by magnitude and added up from the smallest. Every
/// operation here starts from two_sum or two_product, whose results are strongly non-overlapping,
/// and keeps that property (Shewchuk, theorems 13 and 19), which this sum needs.
template <std::size_t M, std::size_t N>
[[nodiscard]] Expansion<M + N> operator+(const Expansion<M>& e, const Expansion<N>& f) noexcept {
  Expansion<M + N> result;
  double running = 0;
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < e.size || j < f.size) {
    const bool take_e = j == f.size || (i < e.size && std::abs(e.term[i]) <= std::abs(f.term[j]));
    const Rounded next = two_sum(running, take_e ? e.term[i++] : f.term[j++]);
    result.append(next.error);
    running = next.value;
  }
  result.append_last(running);
  return result;
}

template <std::size_t N>
[[nodiscard]] Expansion<N> operator-(const Expansion<N>& e) noexcept {
  Expansion<N> result;
  for (std::size_t i = 0; i < e.size; ++i) result.append(-e.term[i]);
  return result;
}

template <std::size_t M, std::size_t N>
[[nodiscard]] Expansion<M + N> operator-(const Expansion<M>& e, const Expansion<N>& f) noexcept {
  return e + (-f);
}

/// e * factor, term by term from the smallest, carrying the rounded part upwards.
template <std::size_t N>
[[nodiscard]] Expansion<2 * N> operator*(const Expansion<N>& e, double factor) noexcept {
  Expansion<2 * N> result;
  double carry = 0;
  for (std::size_t i = 0; i < e.size; ++i) {
    const Rounded product = two_product(e.term[i], factor);
    const Rounded low = two_sum(carry, product.error);
    const Rounded high = fast_two_sum(product.value, low.value);
    result.append(low.error);
    result.append(high.error);
    carry = high.value;
  }
  result.append_last(carry);
  return result;
}

template <std::size_t N>
[[nodiscard]] Expansion<4 * N> operator*(const Expansion<N>& e, const Expansion<2>& f) noexcept {
  Expansion<2 * N> low;
  Expansion<2 * N> high;
  if (f.size > 1) low = e * f.term[0];
  if (f.size > 0) high = e * f.term[f.size - 1];
  return low + high;
}

}  // namespace boxtree
