// SPDX-License-Identifier: MIT
// Every linear map is a rotation, then a scale along the axes, then a rotation or reflection. Two
// nodes can represent it.
#include "cooker/export/placed_shape.h"

#include <cmath>

#include <Eigen/SVD>

#include "runtime/primitive/orientation.h"

namespace boxtree::cooker {
namespace {

// The largest cosine between two axes that counts as rounding. Most poses are products of rotations
// in f32, each of which changes right angles by a few 2^-24. A viewer that drops the remaining
// shear moves points by less than a millionth of their distance from the instance's origin.
constexpr double kLargestCosine = 0x1p-20;

bool shears(const Eigen::Matrix3d& linear) {
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = linear.col(i).stableNormalized();
    const Eigen::Vector3d next = linear.col((i + 1) % 3).stableNormalized();
    if (std::abs(axis.dot(next)) > kLargestCosine) return true;
  }
  return false;
}

// The same map scaled so that products neither overflow nor vanish. Exact, except for entries
// 2^-1000 below the largest.
Eigen::Matrix3d at_unit_size(const Eigen::Matrix3d& linear) {
  const double largest = linear.cwiseAbs().maxCoeff();
  if (!(largest > 0)) return linear;
  const int exponent = std::ilogb(largest);
  return linear.unaryExpr([exponent](double x) { return std::scalbn(x, -exponent); });
}

}  // namespace

bool mirrors(const Pose& pose) {
  const Eigen::Matrix3d linear = at_unit_size(pose.linear());
  return orient3d(linear.col(0), linear.col(1), linear.col(2), Eigen::Vector3d::Zero()) < 0;
}

std::vector<Pose> node_matrices(const Pose& pose) {
  if (!shears(pose.linear())) return {pose};
  const Eigen::Matrix3d linear = pose.linear();
  const Eigen::JacobiSVD<Eigen::Matrix3d> parts(linear, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d outer = parts.matrixU() * parts.singularValues().asDiagonal();
  Eigen::Matrix3d inner = parts.matrixV().transpose();
  if (inner.determinant() < 0) {  // a negative scale represents the mirror
    outer.col(2) = -outer.col(2);
    inner.row(2) = -inner.row(2);
  }
  std::vector<Pose> matrices(2, Pose::Identity());
  matrices[0].linear() = outer;
  matrices[0].translation() = pose.translation();
  matrices[1].linear() = inner;
  return matrices;
}

}  // namespace boxtree::cooker
