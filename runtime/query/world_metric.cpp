// SPDX-License-Identifier: MIT
// The bounds of WorldMetric, each with the error of computing it.
//
// Let u = 2^-53 and gamma_n = n u / (1 - n u) (Higham, "Accuracy and Stability", lemma 3.1). A sum
// of three products is off by gamma_3 of the sum of their magnitudes.
#include "runtime/query/world_metric.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/primitive/rounding.h"
#include "runtime/primitive/vector3.h"
#include "runtime/query/scaled_length.h"
#include "runtime/walk/traversal.h"

namespace boxtree {
namespace {

// Covers the roundings of computing a bound itself: fewer than 16 of them in each.
constexpr double kMore = 1 + 32 * kRoundoffF64;
constexpr double kLess = 1 - 32 * kRoundoffF64;
// A computed inverse with a larger residual is unusable.
constexpr double kTooSingular = 0.25;
// Numbers of shorter rows may have lost digits to underflow, which no residual tells.
constexpr double kLeastLength = 0x1p-960;

// The largest sum of the magnitudes in a row.
double largest_row_sum(const Eigen::Matrix3d& matrix) noexcept {
  return product(matrix.cwiseAbs(), Eigen::Vector3d::Constant(1)).maxCoeff();
}

// An upper bound of the largest singular value of a matrix whose rows have length 1. With B = N
// N^T, |N|^2 = |B| and |B|^4 = |B^4| <= the largest row sum of |B^4|, which for a symmetric 3x3
// matrix is at most sqrt(3) |B^4|: less than 1.08 |N|, and |N| itself for orthogonal rows. B has
// entries of at most 1 and a norm of at least 1, so each rounding of gamma_4 in B, B^2 and B^4
// changes the norm by a factor of less than 1 + 16 u, raised to at most the fourth power: in all
// below 1 + 256 u.
double largest_stretch(const Eigen::Matrix3d& rows) noexcept {
  const Eigen::Matrix3d b = matrix_product(rows, rows.transpose());
  const Eigen::Matrix3d b2 = matrix_product(b, b);
  const double largest_sum = largest_row_sum(matrix_product(b2, b2));
  return std::sqrt(std::sqrt(std::sqrt(largest_sum))) * (1 + 256 * kRoundoffF64);
}

// Rows scaled to length 1, and the lengths. Squares are taken of rows that a power of two has
// brought to size 1: those of an inverse may be as small as another pose is large.
struct UnitRows {
  explicit UnitRows(const Eigen::Matrix3d& matrix) : rows(matrix) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      Eigen::Vector3d row = matrix.row(k).transpose();
      const double size = largest_magnitude(row);
      const int exponent = size > 0 && std::isfinite(size) ? std::ilogb(size) : 0;
      for (Eigen::Index j = 0; j < 3; ++j) row[j] = std::ldexp(row[j], -exponent);
      const double scaled_length = std::sqrt(squared_length(row));
      length[k] = std::ldexp(scaled_length, exponent);
      rows.row(k) = (row / scaled_length).transpose();
    }
  }
  Eigen::Matrix3d rows;
  Eigen::Vector3d length;
};

// The largest component, over the axes, of (A - Y G) z for coordinates z with |z_j| <= bound_j |v|,
// in units of |Y_k| |v|. The residual is measured with gamma_4 of the magnitudes that enter it.
double relative_residual(const Eigen::Matrix3d& a, const Eigen::Matrix3d& y,
                         const Eigen::Vector3d& y_length, const Eigen::Matrix3d& g,
                         const Eigen::Vector3d& bound) noexcept {
  const Eigen::Matrix3d residual =
      (matrix_product(y, g) - a).cwiseAbs() +
      8 * kRoundoffF64 * (matrix_product(y.cwiseAbs(), g.cwiseAbs()) + a.cwiseAbs());
  double largest = 0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double relative = dot(residual.row(k).transpose(), bound) / y_length[k] * kMore;
    if (relative > largest || std::isnan(relative)) largest = relative;  // NaN stays
  }
  return largest;
}

// Weights of the axes of A, given a bound of the coordinates of the first space. |a_k . z| is at
// most |Y_k v| + |(A - Y G)_k z| <= (1 + r) |Y_k| |v|, and |D^-1 A z| <= (|D^-1 Y| + sqrt(3) r)
// |v|.
GapWeights weights_of(const Eigen::Matrix3d& a, const Eigen::Matrix3d& y, const Eigen::Matrix3d& g,
                      const Eigen::Vector3d& bound) noexcept {
  GapWeights result;
  const UnitRows unit(y);
  const double residual = relative_residual(a, y, unit.length, g, bound);
  if (!(residual < kTooSingular)) return result;  // weights of zero: gaps give no bound
  for (std::size_t k = 0; k < 3; ++k) {
    const double length = unit.length[static_cast<Eigen::Index>(k)];
    result.weight[k] = kLess / (length * (1 + residual));
    if (!(length > kLeastLength) || !std::isfinite(result.weight[k])) return GapWeights();
  }
  const double stretch = largest_stretch(unit.rows) + 2 * residual;
  if (!std::isfinite(stretch)) return GapWeights();
  result.combined = stretch > 1 ? 1 / (stretch * stretch) * kLess : kLess;
  if (!(result.combined > 0)) result.combined = 0;
  return result;
}

}  // namespace

std::optional<WorldMetric> WorldMetric::make(const BoundTree& first, const Pose& first_pose,
                                             const BoundTree& second,
                                             const RelativePose& pose) noexcept {
  WorldMetric metric;
  const Eigen::Matrix3d linear = first_pose.linear();
  const double size = linear.cwiseAbs().maxCoeff();
  if (!(size > 0) || !std::isfinite(size)) return std::nullopt;
  const int pose_exponent = std::ilogb(size);
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      metric.linear_(i, j) = std::ldexp(linear(i, j), -pose_exponent);
      // Some entries are too small to be represented in the units of the largest.
      if (std::ldexp(metric.linear_(i, j), pose_exponent) != linear(i, j)) return std::nullopt;
    }
  }
  metric.exponent_ = pose_exponent + first.scale_exponent();
  const Eigen::Matrix3d& g = metric.linear_;

  // The coordinates of z = x - y. From z = Y v - (Y G - I) z, with the residual measured in units
  // of |Y_k|: |z_k| <= |Y_k| |v| / (1 - r).
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d inverse;
  static_cast<void>(invert_by_cofactors(g, inverse));
  const Eigen::Vector3d length = UnitRows(inverse).length;
  const double residual = relative_residual(identity, inverse, length, g, length);
  metric.inverse_ = inverse;
  metric.coordinate_.setConstant(std::numeric_limits<double>::infinity());
  if (residual < kTooSingular) {
    const Eigen::Vector3d bound = length / (1 - residual) * kMore;
    metric.coordinate_ = bound;
    metric.in_first_ = weights_of(identity, inverse, g, bound);
    const Eigen::Matrix3d& to_second = pose.to_second().linear;
    metric.in_second_ = weights_of(to_second, matrix_product(to_second, inverse), g, bound);
  }
  // Images of the second tree's points are off by to_second_error; those of the first tree's, which
  // the hull of a box holds as they are computed, by gamma_4 of the terms.
  const Eigen::Vector3d terms = product(pose.to_second().linear.cwiseAbs(), first.max_abs()) +
                                pose.to_second().translation.cwiseAbs();
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    metric.in_second_.margin[k] =
        (pose.to_second_error()[axis] + 8 * kRoundoffF64 * terms[axis]) * kMore;
  }

  metric.place_ = first.max_abs() + product(pose.to_first().linear.cwiseAbs(), second.max_abs()) +
                  pose.to_first().translation.cwiseAbs();

  // |G z| = |(G C^-1) (C z)|, C the lengths of the columns.
  const UnitRows columns(g.transpose());
  for (std::size_t k = 0; k < 3; ++k) {
    metric.column_[k] = columns.length[static_cast<Eigen::Index>(k)] * kMore;
  }
  metric.stretch_ = largest_stretch(columns.rows) * kMore;
  // A rounded difference, three products and two sums: gamma_4 of at most row sum times largest
  // magnitude in each of three components.
  metric.image_error_ = 8 * kRoundoffF64 * largest_row_sum(g);
  return metric;
}

double WorldMetric::squared_distance(const Box<double>& first, const Box<double>& second,
                                     const RelativePose& pose) const noexcept {
  return std::max(in_first_.squared_distance(first, pose.to_first().hull(second)),
                  in_second_.squared_distance(pose.to_second().hull(first), second));
}

// The axes U of the world give coordinates of z by the rows n of N = U G: lengths in the world,
// since N G^-1 is U but for rounding, which weights_of() measures.
//
// n . (y - x) for x in a box of the first tree and y = fl(L w + t), w in a box of the second, is
// computed as (n . t + (L^T n) . w) - n . x. Magnitudes are at most |n| . place, and no term passes
// through more than 4 roundings in y, 4 in L^T n, 4 in its product with w and 3 in the differences;
// boxes may extend beyond the root's by one rounding.
AlignedAxes WorldMetric::axes_along(const Eigen::Vector3d& along,
                                    const RelativePose& pose) const noexcept {
  AlignedAxes result;
  const double size = along.cwiseAbs().maxCoeff();
  if (!(size > 0) || !std::isfinite(size)) return result;
  const Eigen::Vector3d to = along / size;
  // The axis that is farthest from it makes the largest cross product, at least sqrt(2/3) of it.
  Eigen::Vector3d beside = Eigen::Vector3d::Zero();
  Eigen::Index least = 0;
  for (Eigen::Index k = 1; k < 3; ++k) {
    if (std::abs(to[k]) < std::abs(to[least])) least = k;
  }
  beside[least] = 1;
  const Eigen::Vector3d across = cross(to, beside);
  const Eigen::Vector3d first = to / std::sqrt(squared_length(to));
  const Eigen::Vector3d second = across / std::sqrt(squared_length(across));
  Eigen::Matrix3d axes;
  axes.row(0) = first.transpose();
  axes.row(1) = second.transpose();
  axes.row(2) = cross(first, second).transpose();
  const Eigen::Matrix3d n = matrix_product(axes, linear_);
  result.weights_ = weights_of(n, matrix_product(n, inverse_), linear_, coordinate_);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    result.weights_.margin[k] = 32 * kRoundoffF64 * dot(n.row(row).transpose().cwiseAbs(), place_);
  }
  result.map_[0].linear = n;
  result.map_[1].linear = matrix_product(n, pose.to_first().linear);
  result.map_[1].translation = product(n, pose.to_first().translation);
  return result;
}

Box<double> AlignedAxes::extent_of(std::size_t tree, const Box<double>& box) const noexcept {
  return map_[tree].hull(box);
}
Box<double> AlignedAxes::extent_of(std::size_t tree, const Triangle& triangle) const noexcept {
  return bounds_of(map_[tree].apply(triangle));
}
double AlignedAxes::squared_distance(const Box<double>& first,
                                     const Box<double>& second) const noexcept {
  return weights_.squared_distance(first, second);
}

double WorldMetric::length_below(double length) const noexcept {
  return scaled_below(length, exponent_);
}

double WorldMetric::length_above(double length) const noexcept {
  return scaled_above(length, exponent_);
}

double WorldMetric::from_world_below(double length) const noexcept {
  return scaled_below(length, -exponent_);
}

double WorldMetric::from_world_above(double length) const noexcept {
  return scaled_above(length, -exponent_);
}

}  // namespace boxtree
