// SPDX-License-Identifier: MIT
// Products and inverses in three dimensions, each operation in the order written. Eigen's own sums
// are ordered or fused differently for each instruction set, which would change the last bits of
// distances, contacts and the cooker's choices.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include <Eigen/Core>

namespace boxtree {

/// The largest of three magnitudes; NaN if one of them is. Compares bits, which ascend with the
/// magnitude, NaN after infinity.
[[nodiscard]] inline double largest_magnitude(double x, double y, double z) noexcept {
  constexpr std::uint64_t kMagnitude = ~std::uint64_t{0} >> 1;
  const auto bits = [](double v) { return std::bit_cast<std::uint64_t>(v) & kMagnitude; };
  return std::bit_cast<double>(std::max(std::max(bits(x), bits(y)), bits(z)));
}
[[nodiscard]] inline double largest_magnitude(const Eigen::Vector3d& v) noexcept {
  return largest_magnitude(v[0], v[1], v[2]);
}

[[nodiscard]] inline double dot(const Eigen::Vector3d& a, const Eigen::Vector3d& b) noexcept {
  return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

[[nodiscard]] inline double squared_length(const Eigen::Vector3d& a) noexcept {
  return dot(a, a);
}

[[nodiscard]] inline Eigen::Vector3d cross(const Eigen::Vector3d& a,
                                           const Eigen::Vector3d& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// m v.
[[nodiscard]] inline Eigen::Vector3d product(const Eigen::Matrix3d& m,
                                             const Eigen::Vector3d& v) noexcept {
  return {(m(0, 0) * v[0] + m(0, 1) * v[1]) + m(0, 2) * v[2],
          (m(1, 0) * v[0] + m(1, 1) * v[1]) + m(1, 2) * v[2],
          (m(2, 0) * v[0] + m(2, 1) * v[1]) + m(2, 2) * v[2]};
}

/// a b.
[[nodiscard]] inline Eigen::Matrix3d matrix_product(const Eigen::Matrix3d& a,
                                                    const Eigen::Matrix3d& b) noexcept {
  Eigen::Matrix3d out;
  for (Eigen::Index j = 0; j < 3; ++j) out.col(j) = product(a, b.col(j));
  return out;
}

/// Cofactors divided by the determinant, which is returned. An entry is meaningless where a product
/// of three entries of the matrix overflows or underflows.
[[nodiscard]] inline double invert_by_cofactors(const Eigen::Matrix3d& m,
                                                Eigen::Matrix3d& inverse) noexcept {
  // The cofactors of a column.
  const Eigen::Vector3d x = m.col(0), y = m.col(1), z = m.col(2);
  const Eigen::Vector3d of_x = cross(y, z), of_y = cross(z, x), of_z = cross(x, y);
  const double determinant = (x[0] * of_x[0] + y[0] * of_y[0]) + z[0] * of_z[0];
  for (Eigen::Index j = 0; j < 3; ++j) {
    inverse.col(j) = Eigen::Vector3d(of_x[j], of_y[j], of_z[j]) / determinant;
  }
  return determinant;
}

/// The power of two that scales the largest magnitude into [1, 2), but at most 2^1023; 1 for zeros,
/// and for what is not finite.
template <class Vector>
[[nodiscard]] double scale_to_one(const Vector& v) noexcept {
  const double largest = std::max(std::max(std::abs(v[0]), std::abs(v[1])), std::abs(v[2]));
  constexpr int kLargestExponent = std::numeric_limits<double>::max_exponent - 1;
  if (!(largest > 0) || !std::isfinite(largest)) return 1;
  return std::ldexp(1.0, std::min(-std::ilogb(largest), kLargestExponent));
}

/// The inverse of a matrix whose rows and columns are first scaled to the size of 1 by powers of
/// two. The result is that of inverse_of() except where that overflows or underflows on the way.
[[nodiscard]] inline Eigen::Matrix3d balanced_inverse_of(const Eigen::Matrix3d& m) noexcept {
  Eigen::Matrix3d balanced = m;
  Eigen::Vector3d row, column;
  for (Eigen::Index i = 0; i < 3; ++i) {
    row[i] = scale_to_one(balanced.row(i));
    balanced.row(i) *= row[i];
  }
  for (Eigen::Index j = 0; j < 3; ++j) {
    column[j] = scale_to_one(balanced.col(j));
    balanced.col(j) *= column[j];
  }
  Eigen::Matrix3d inverse;
  static_cast<void>(invert_by_cofactors(balanced, inverse));
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) inverse(i, j) = (inverse(i, j) * column[i]) * row[j];
  }
  return inverse;
}

/// Not finite where the matrix is not invertible.
[[nodiscard]] inline Eigen::Matrix3d inverse_of(const Eigen::Matrix3d& m) noexcept {
  Eigen::Matrix3d inverse;
  const double determinant = std::abs(invert_by_cofactors(m, inverse));
  // Then no cofactor has overflowed, and what underflow took from them is below 2^-600.
  constexpr double kLeast = 0x1p-400, kLargest = 0x1p400;
  if (kLeast < determinant && determinant < kLargest) [[likely]]
    return inverse;
  return balanced_inverse_of(m);
}

}  // namespace boxtree
