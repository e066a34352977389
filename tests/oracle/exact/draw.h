// SPDX-License-Identifier: MIT
// Seeded draws of numbers, the same on every machine and standard library.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace boxtree::oracle {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : state_(seed) {}

  /// SplitMix64 (Steele, Lea, Flood 2014).
  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  /// 0 to n - 1.
  std::uint32_t below(std::uint32_t n) {
    return static_cast<std::uint32_t>(((bits() >> 32) * n) >> 32);
  }
  int between(int low, int high) {
    return low + static_cast<int>(below(static_cast<std::uint32_t>(high - low + 1)));
  }
  bool one_in(std::uint32_t n) { return below(n) == 0; }
  /// In [0, 1), and in [-1, 1).
  double part() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double unit() { return 2 * part() - 1; }
  double sign() { return one_in(2) ? 1 : -1; }
  double power(int low, int high) { return std::ldexp(1.0, between(low, high)); }

  /// Any finite f32: exponents alike, subnormal numbers and zeros of both signs among them.
  float any_f32(int low = -149, int high = 127) {
    if (one_in(16)) return one_in(2) ? 0.0F : -0.0F;
    const double x = std::ldexp((1 + part()) * sign(), between(low, high));
    const auto rounded = static_cast<float>(x);
    return std::isfinite(rounded) ? rounded
                                  : std::copysign(std::numeric_limits<float>::max(), rounded);
  }
  /// Any finite double, likewise.
  double any_f64(int low = -1074, int high = 1023) {
    if (one_in(16)) return one_in(2) ? 0.0 : -0.0;
    const double x = std::ldexp((1 + part()) * sign(), between(low, high));
    return std::isfinite(x) ? x : std::copysign(std::numeric_limits<double>::max(), x);
  }
  /// The number itself, or one of its next neighbours.
  double nudged(double x) {
    const auto choice = below(3);
    if (choice == 0) return x;
    const double to = std::numeric_limits<double>::infinity();
    const double y = std::nextafter(x, choice == 1 ? to : -to);
    return std::isfinite(y) ? y : x;
  }

 private:
  std::uint64_t state_;
};

/// A seed of its own for each number of a sequence.
[[nodiscard]] inline std::uint64_t seed_of(std::uint64_t seed, std::uint64_t family,
                                           std::uint64_t number) {
  return Draw(Draw(seed).bits() ^ Draw(family).bits() ^ (number * 0x9e3779b97f4a7c15u)).bits();
}

}  // namespace boxtree::oracle
