// SPDX-License-Identifier: MIT
// Composition of two poses and two frames into one affine map and its inverse, with an error bound.
#include <boxtree/runtime/primitive/vector3.h>
#include <boxtree/runtime/query/relative_pose.h>
#include <boxtree/runtime/query/traversal.h>

namespace boxtree {

std::optional<RelativePose> RelativePose::make(const Tree& first, const Pose& first_pose,
                                               const Tree& second,
                                               const Pose& second_pose) noexcept {
  const Frame& f = first.frame();
  const Frame& s = second.frame();
  const Eigen::Matrix3d first_linear = first_pose.linear();
  const Eigen::Matrix3d second_linear = second_pose.linear();
  const Eigen::Matrix3d first_inverse = inverse_of(first_linear);

  RelativePose relative;
  relative.to_first_.linear =
      matrix_product(first_inverse, second_linear) * (s.scale * f.inverse_scale);
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
  constexpr double kUnitRoundoff = std::numeric_limits<double>::epsilon() / 2;
  constexpr double kGamma16 = 16 * kUnitRoundoff / (1 - 16 * kUnitRoundoff);
  const Eigen::Vector3d y = reach_of(second);
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
  if (!relative.margin_.allFinite() || !is_within_reach(x)) return std::nullopt;
  return relative;
}

}  // namespace boxtree
