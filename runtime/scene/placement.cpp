// SPDX-License-Identifier: MIT
// Maps of placed trees and their error bounds.
#include "runtime/scene/placement.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/primitive/rounding.h"
#include "runtime/primitive/vector3.h"
#include "runtime/query/scaled_length.h"

namespace boxtree {
namespace {

// Zero times a number that is not finite is not a number, and stays so in sums.
bool is_finite(const Eigen::Matrix3d& m) noexcept {
  double sum = 0;
  for (Eigen::Index i = 0; i < m.size(); ++i) sum += 0 * m.data()[i];
  return sum == 0;
}

Eigen::Matrix3d magnitudes(const Eigen::Matrix3d& m) noexcept {
  return m.cwiseAbs();
}

// The largest row sum of |m| |inverse|.
double condition_of(const Eigen::Matrix3d& m, const Eigen::Matrix3d& inverse) noexcept {
  const Eigen::Matrix3d a = magnitudes(m), b = magnitudes(inverse);
  double largest = 0;
  for (Eigen::Index i = 0; i < 3; ++i) {
    double sum = 0;
    for (Eigen::Index k = 0; k < 3; ++k) sum += (a(i, k) * ((b(k, 0) + b(k, 1)) + b(k, 2)));
    largest = std::max(largest, sum);
  }
  return largest;
}

}  // namespace

// The scale is a power of two: no rounding. For a frame with origin 0 the sum is the pose's
// translation, unrounded.
AffineMap Placement::map_to_world(const Frame& frame, const Pose& pose) noexcept {
  return {pose.linear() * frame.scale, product(pose.linear(), frame.origin) + pose.translation()};
}

std::optional<Placement> Placement::make(const Frame& frame, const Pose& pose) noexcept {
  Placement placed;
  placed.to_world_ = map_to_world(frame, pose);
  placed.inverse_ = inverse_of(pose.linear());
  placed.translation_ = pose.translation();
  placed.frame_origin_ = frame.origin;
  placed.frame_inverse_scale_ = frame.inverse_scale;
  if (!is_finite(placed.to_world_.linear) || !is_finite(placed.inverse_) ||
      !is_within_range(placed.to_world_.translation)) {
    return std::nullopt;
  }
  return placed;
}

Eigen::Matrix3d Placement::linear() const noexcept {
  return to_world_.linear * frame_inverse_scale_;  // a power of two: no rounding
}

double Placement::condition() const noexcept {
  return condition_of(linear(), inverse_);
}

double Placement::magnitude(const Box<double>& root) const noexcept {
  const Eigen::Vector3d terms = product(magnitudes(to_world_.linear), max_abs_of(root)) +
                                product(magnitudes(linear()), frame_origin_.cwiseAbs()) +
                                translation_.cwiseAbs();
  return std::max({terms[0], terms[1], terms[2]});
}

std::optional<PlacementBounds> Placement::bounds(const Box<double>& root) const noexcept {
  PlacementBounds bounds{to_world_.hull(root), condition(), magnitude(root)};
  if (!std::isfinite(bounds.condition) || !(bounds.magnitude <= kMaxCoordinate))
    return std::nullopt;
  for (std::size_t k = 0; k < 3; ++k) {
    bounds.world.low[k] -= bounds.error();
    bounds.world.high[k] += bounds.error();
  }
  return bounds;
}

// A world coordinate is a sum of nine terms, each rounded; on the way back the error of each
// coordinate is spread by |L| |L^-1|, whose rounding and that of the comparison itself are counted
// generously: 64 roundings in all.
double PlacementBounds::error() const noexcept {
  return 64 * kRoundoffF64 * condition * magnitude + kLeastError;
}

Ray Placement::to_object(const Ray& world) const noexcept {
  Ray ray = world;
  ray.origin = product(inverse_, world.origin - translation_);
  ray.direction = product(inverse_, world.direction);
  return ray;
}

Eigen::Vector3d Placement::to_tree(const Eigen::Vector3d& world) const noexcept {
  return (product(inverse_, world - translation_) - frame_origin_) * frame_inverse_scale_;
}

Eigen::Vector3d Placement::vector_to_tree(const Eigen::Vector3d& world) const noexcept {
  return product(inverse_, world) * frame_inverse_scale_;
}

// The error of the inverse is measured by mapping there and back. Added are the roundings of the
// measurement, of a triangle's map to the world and of its distance, which are bounded by 26 of the
// largest coordinate (see triangle_distance.cpp).
double Placement::distance_error(const Eigen::Vector3d& tree, const Eigen::Vector3d& world,
                                 const Box<double>& root) const noexcept {
  const Eigen::Vector3d back = to_world_.apply(tree) - world;
  const Eigen::Vector3d terms = product(magnitudes(to_world_.linear), tree.cwiseAbs());
  const double largest = std::max({terms[0], terms[1], terms[2]}) + magnitude(root) +
                         std::max({std::abs(world[0]), std::abs(world[1]), std::abs(world[2])});
  return std::sqrt(squared_length(back)) + 128 * kRoundoffF64 * largest + kLengthUnderflow;
}

// Measured likewise; each coordinate of the difference is a sum of four terms.
double Placement::vector_error(const Eigen::Vector3d& tree,
                               const Eigen::Vector3d& world) const noexcept {
  const Eigen::Vector3d missing = product(to_world_.linear, tree) - world;
  const Eigen::Vector3d terms = product(magnitudes(to_world_.linear), tree.cwiseAbs());
  const double largest = largest_magnitude(terms) + largest_magnitude(world);
  return std::sqrt(squared_length(missing)) + 16 * kRoundoffF64 * largest + kLengthUnderflow;
}

// The squares of both are eigenvalues of L^T L, which lie in Gershgorin's circles. Where axes are
// far from orthogonal the circles contain zero. Then 1 / |L^-1|, in the Frobenius norm, is a lower
// bound, corrected for the error of the computed inverse X: |L^-1| <= |X| / (1 - |I - L X|).
Stretch stretch_of(const Eigen::Matrix3d& linear) noexcept {
  const Eigen::Vector3d x = linear.col(0), y = linear.col(1), z = linear.col(2);
  const double xx = squared_length(x), yy = squared_length(y), zz = squared_length(z);
  const double xy = std::abs(dot(x, y)), yz = std::abs(dot(y, z)), zx = std::abs(dot(z, x));
  // Entries of the product are off by 3u of the magnitudes summed, which the diagonal's sum bounds.
  const double off = 16 * kRoundoffF64 * ((xx + yy) + zz);
  const double smallest = std::min({xx - (xy + zx), yy - (xy + yz), zz - (zx + yz)}) - off;
  const double largest = std::max({xx + (xy + zx), yy + (xy + yz), zz + (zx + yz)}) + off;
  Stretch stretch{std::sqrt(std::max(0.0, smallest)) * (1 - 4 * kRoundoffF64),
                  std::sqrt(largest) * (1 + 4 * kRoundoffF64)};
  // Within sqrt(3) of the shortest axis, and so of the best bound: the norm guarantees no more.
  if (3 * smallest >= std::min({xx, yy, zz})) return stretch;
  const Eigen::Matrix3d inverse = inverse_of(linear);
  double norm = 0, lacking = 0;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      norm += inverse(i, j) * inverse(i, j);
      double entry = i == j ? 1 : 0;
      double terms = entry;
      for (Eigen::Index k = 0; k < 3; ++k) {
        entry -= linear(i, k) * inverse(k, j);
        terms += std::abs(linear(i, k) * inverse(k, j));
      }
      const double residual = std::abs(entry) + 8 * kRoundoffF64 * terms;
      lacking += residual * residual;
    }
  }
  const double other = (1 - std::sqrt(lacking)) / std::sqrt(norm) * (1 - 32 * kRoundoffF64);
  if (other > stretch.least) stretch.least = other;  // false for NaN
  return stretch;
}

}  // namespace boxtree
