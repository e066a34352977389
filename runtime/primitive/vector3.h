// SPDX-License-Identifier: MIT
// Products and inverses in three dimensions, each operation in the order written: sums by Eigen's
// own come in another order, or fused, with another instruction set, and distances, contacts and
// what the cooker chooses would differ by it in their last bits.
#pragma once

#include <Eigen/Core>

namespace boxtree {

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
  Eigen::Vector3d out;
  for (Eigen::Index i = 0; i < 3; ++i) {
    out[i] = (m(i, 0) * v[0] + m(i, 1) * v[1]) + m(i, 2) * v[2];
  }
  return out;
}

/// a b.
[[nodiscard]] inline Eigen::Matrix3d matrix_product(const Eigen::Matrix3d& a,
                                                    const Eigen::Matrix3d& b) noexcept {
  Eigen::Matrix3d out;
  for (Eigen::Index j = 0; j < 3; ++j) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      out(i, j) = (a(i, 0) * b(0, j) + a(i, 1) * b(1, j)) + a(i, 2) * b(2, j);
    }
  }
  return out;
}

/// Cofactors over the determinant. Not finite where the matrix is not invertible.
[[nodiscard]] inline Eigen::Matrix3d inverse_of(const Eigen::Matrix3d& m) noexcept {
  Eigen::Matrix3d cofactor;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      const Eigen::Index r = (i + 1) % 3, s = (i + 2) % 3;
      const Eigen::Index c = (j + 1) % 3, d = (j + 2) % 3;
      cofactor(i, j) = m(r, c) * m(s, d) - m(r, d) * m(s, c);
    }
  }
  const double determinant =
      (m(0, 0) * cofactor(0, 0) + m(0, 1) * cofactor(0, 1)) + m(0, 2) * cofactor(0, 2);
  Eigen::Matrix3d inverse;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) inverse(i, j) = cofactor(j, i) / determinant;
  }
  return inverse;
}

}  // namespace boxtree
