// SPDX-License-Identifier: MIT
#include "cooker/text/pose_fault.h"

#include <cmath>

#include <fmt/format.h>

#include "runtime/primitive/vector3.h"

namespace boxtree::cooker {
namespace {

// The same directions, with a largest entry from 1 to 2. Precondition: finite, and not zero.
Eigen::Matrix3d of_size_one(const Eigen::Matrix3d& linear) noexcept {
  const int exponent = std::ilogb(linear.cwiseAbs().maxCoeff());
  const int half = exponent / 2;  // 2^-exponent may be beyond the range of doubles
  return (linear * std::ldexp(1.0, -half)) * std::ldexp(1.0, half - exponent);
}

bool has_double_inverse(const Eigen::Matrix3d& linear) noexcept {
  const Eigen::Matrix3d inverse = inverse_of(linear);
  const Eigen::Matrix3d product = matrix_product(inverse, linear);
  return inverse.allFinite() && product.allFinite() && inverse_of(product).allFinite();
}

}  // namespace

bool has_double_inverse(const Pose& pose) noexcept {
  return has_double_inverse(Eigen::Matrix3d(pose.linear()));
}

std::string pose_fault(const Pose& pose) {
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column) {
      const double number = pose(row, column);
      if (std::isfinite(number)) continue;
      return fmt::format("is not finite: row {}, column {} is {}", row + 1, column + 1, number);
    }
  }
  const Eigen::Matrix3d linear = pose.linear();
  if (linear.isZero(0)) return "is not invertible: its matrix is zero";
  if (!has_double_inverse(of_size_one(linear))) {
    return "is not invertible: it flattens what it places";
  }
  if (!has_double_inverse(linear)) return "is not invertible: it scales beyond the range of double";
  return "leads too far away: coordinates may be 2^185 mesh extents";
}

}  // namespace boxtree::cooker
