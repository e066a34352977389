// SPDX-License-Identifier: MIT
// Composition of two poses and two frames into one affine map and its inverse, with an error bound.
#include "runtime/query/relative_pose.h"

#include <algorithm>
#include <cmath>

#include "runtime/primitive/rounding.h"
#include "runtime/primitive/vector3.h"
#include "runtime/walk/traversal.h"

namespace boxtree {
namespace {

// The largest magnitude of an entry.
double largest(const Eigen::Matrix3d& m) noexcept {
  return m.cwiseAbs().maxCoeff();
}

// m * 2^exponent, for exponents beyond those of a double, too.
Eigen::Matrix3d scaled(const Eigen::Matrix3d& m, int exponent) noexcept {
  const int half = exponent / 2;
  return (m * std::ldexp(1.0, half)) * std::ldexp(1.0, exponent - half);
}

// a b 2^exponent. Matrices so large or small that products of entries could overflow or lose bits
// are brought to the size of 1 first, which changes no other bit.
Eigen::Matrix3d composed(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b,
                         int exponent) noexcept {
  const double size_a = largest(a), size_b = largest(b);
  const auto is_moderate = [](double size) { return 0x1p-300 < size && size < 0x1p300; };
  if (is_moderate(size_a) && is_moderate(size_b) && std::abs(exponent) < 1000) [[likely]] {
    return matrix_product(a, b) * std::ldexp(1.0, exponent);
  }
  if (!std::isfinite(size_a) || !std::isfinite(size_b) || size_a == 0 || size_b == 0) {
    return Eigen::Matrix3d::Zero();  // not invertible
  }
  const int exponent_a = std::ilogb(size_a), exponent_b = std::ilogb(size_b);
  return scaled(matrix_product(scaled(a, -exponent_a), scaled(b, -exponent_b)),
                exponent_a + exponent_b + exponent);
}

}  // namespace

std::optional<RelativePose> RelativePose::make(const BoundTree& first, const Pose& first_pose,
                                               const BoundTree& second,
                                               const Pose& second_pose) noexcept {
  const Frame& f = first.frame();
  const Frame& s = second.frame();
  const Eigen::Matrix3d first_linear = first_pose.linear();
  const Eigen::Matrix3d second_linear = second_pose.linear();
  const Eigen::Matrix3d first_inverse = inverse_of(first_linear);

  RelativePose relative;
  relative.to_first_.linear =
      composed(first_inverse, second_linear, second.scale_exponent() - first.scale_exponent());
  // Differences first: two bodies far out in the world, or baked far from their origins, lose
  // nothing to the large common part.
  const Eigen::Vector3d between =
      (second_pose.translation() - first_pose.translation()) +
      (product(second_linear, s.origin) - product(first_linear, f.origin));
  relative.to_first_.translation = product(first_inverse, between) * f.inverse_scale;

  const Eigen::Matrix3d inverse = inverse_of(relative.to_first_.linear);
  relative.to_second_.linear = inverse;
  relative.to_second_.translation = -product(inverse, relative.to_first_.translation);
  if (!relative.to_first_.linear.allFinite() || !relative.to_first_.translation.allFinite() ||
      !inverse.allFinite() || !relative.to_second_.translation.allFinite()) {
    return std::nullopt;
  }

  // For y in second's root box and x = L y + t, how far can the computed inverse map of x lie from
  // y? The residuals of the inverse are measured; gamma_16 covers the at most 16 roundings of
  // measuring and of applying it (Higham, "Accuracy and Stability", lemma 3.1).
  constexpr double kGamma16 = 16 * kRoundoffF64 / (1 - 16 * kRoundoffF64);
  const Eigen::Vector3d y = second.max_abs();
  const Eigen::Vector3d x =
      product(relative.to_first_.linear.cwiseAbs(), y) + relative.to_first_.translation.cwiseAbs();
  const Eigen::Matrix3d residual =
      (matrix_product(inverse, relative.to_first_.linear) - Eigen::Matrix3d::Identity()).cwiseAbs();
  const Eigen::Vector3d offset =
      (product(inverse, relative.to_first_.translation) + relative.to_second_.translation)
          .cwiseAbs();
  relative.margin_ =
      product(residual, y) + offset +
      kGamma16 * (product(inverse.cwiseAbs(), x) + relative.to_second_.translation.cwiseAbs() + y);
  if (!relative.margin_.allFinite() || !is_within_range(x)) return std::nullopt;
  return relative;
}

}  // namespace boxtree
