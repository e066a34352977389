// SPDX-License-Identifier: MIT
// Bounds that decide the step of a grid; their last bits must not depend on the machine.
#include "cooker/scene/precision.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace boxtree::cooker {
namespace {

// The largest magnitude if no row and no column has more than one non-zero number: such a matrix
// stretches along the axes. Otherwise empty.
std::optional<double> stretch_along_axes(const Eigen::Matrix3d& m) noexcept {
  double largest = 0;
  std::array<int, 3> in_row{}, in_column{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (m(i, j) == 0) continue;
      largest = std::max(largest, std::abs(m(i, j)));
      if (++in_row[static_cast<std::size_t>(i)] > 1) return std::nullopt;
      if (++in_column[static_cast<std::size_t>(j)] > 1) return std::nullopt;
    }
  }
  return largest;
}

double largest_magnitude(const Eigen::Matrix3d& m) noexcept {
  double largest = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) largest = std::max(largest, std::abs(m(i, j)));
  }
  return largest;
}

Eigen::Matrix3d scaled(const Eigen::Matrix3d& m, int exponent) noexcept {
  Eigen::Matrix3d result;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) result(i, j) = std::ldexp(m(i, j), exponent);
  }
  return result;
}

// M^T M, with a fixed order of additions.
Eigen::Matrix3d gram(const Eigen::Matrix3d& m) noexcept {
  Eigen::Matrix3d result;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      result(i, j) = m(0, i) * m(0, j) + m(1, i) * m(1, j) + m(2, i) * m(2, j);
    }
  }
  return result;
}

}  // namespace

// With B = A^T A, |A|^2 = |B|, and for symmetric B |B|^2 = |B^2| = |B^T B|. After n squarings the
// largest row sum is at most sqrt(3) |B^(2^n)|. Its 2^(n+1)-th root errs by a factor of 3 to the
// power of 2^-(n+2), below 1.00007 for n = 12. Matrices are kept near 1 by powers of two. Each
// product changes the norm by less than 16 u of it (gamma_3 of the product of the magnitudes, whose
// norm is at most three times as large). Each root halves the share of that error and of the roots'
// own errors in the result: less than 64 u in all.
double largest_stretch(const Eigen::Matrix3d& linear) noexcept {
  if (const auto along_axes = stretch_along_axes(linear)) return *along_axes;
  constexpr std::size_t kSquarings = 12;
  constexpr double kMore = 1 + 32 * std::numeric_limits<double>::epsilon();
  const int unit = std::ilogb(largest_magnitude(linear));
  Eigen::Matrix3d b = gram(scaled(linear, -unit));
  std::array<int, kSquarings> exponents{};
  for (int& exponent : exponents) {
    exponent = std::ilogb(largest_magnitude(b));
    b = gram(scaled(b, -exponent));
  }
  double bound = 0;
  for (int i = 0; i < 3; ++i) {
    bound = std::max(bound, std::abs(b(i, 0)) + std::abs(b(i, 1)) + std::abs(b(i, 2)));
  }
  for (std::size_t n = kSquarings; n-- > 0;) bound = std::ldexp(std::sqrt(bound), exponents[n]);
  return std::ldexp(std::sqrt(bound) * kMore, unit);
}

double largest_surface_error(const ContactRule& rule) noexcept {
  const double weight = rule.mass.value * rule.gravity.value;
  if (rule.invisible.value) return 0.1 * weight / rule.stiffness.value;
  return std::sqrt(2 * weight * rule.jump.value / rule.stiffness.value);
}

double divided_below(double length, double scale) noexcept {
  const double quotient = length / scale;
  return std::fma(quotient, scale, -length) > 0 ? std::nextafter(quotient, 0.0) : quotient;
}

}  // namespace boxtree::cooker
