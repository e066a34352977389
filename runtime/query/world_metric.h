// SPDX-License-Identifier: MIT
// World distances of objects that are compared in the spaces of two trees.
//
// A pair query moves the second tree's triangles into the first one's tree space and compares them
// there. The world is the image of that space under a linear map G (the first pose and the scale of
// the tree): points x and y of it are |G (x - y)| apart in the world. G may scale, mirror and
// shear.
//
// Why gaps between boxes are lower bounds. Let z = x - y and v = G z, and let a row a of a matrix A
// give a coordinate a . z: of the first space itself (A = I) or of the second (A = the map to it).
// With Y = A G^-1, |a . z| = |Y_k v| <= |Y_k| |v|: a gap g_k of two boxes on axis k separates them
// by at least g_k / |Y_k| in the world. Gaps on several axes together: let D = diag(|Y_k|). Then
// |D^-1 A z| = |D^-1 Y v| <= |D^-1 Y| |v|, so |v| >= |D^-1 g| / |D^-1 Y|, whose denominator is 1
// where the axes stay orthogonal in the world (rotation, mirror, scale along them) and at most
// sqrt(3) where shear brings them together. The larger of the two bounds counts.
// Y is computed with rounding; the residual A - Y G is measured and added (world_metric.cpp).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "runtime/primitive/triangle.h"
#include "runtime/query/relative_pose.h"
#include "runtime/query/scaled_length.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree {

/// Lower bounds of distances from gaps between boxes in one space.
struct GapWeights {
  std::array<double, 3> weight{};  // world length of a unit gap on each axis, at least
  double combined = 0;             // of squares: lower bound of three gaps together
  std::array<double, 3> margin{};  // by how much a gap may be too large

  /// A lower bound of the squared distance between the contents of two boxes. Never NaN: invalid
  /// boxes have distance 0.
  template <class S, class T>
  [[nodiscard]] double squared_distance(const Box<S>& a, const Box<T>& b) const noexcept {
    double sum = 0;
    double largest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double apart =
          std::max(double{a.low[k]} - double{b.high[k]}, double{b.low[k]} - double{a.high[k]});
      const double gap = std::max(0.0, (apart - margin[k]) * weight[k]);
      sum += gap * gap;
      largest = std::max(largest, gap * gap);
    }
    return std::max(largest, combined * sum);
  }
};

/// Three axes of the world at right angles, the first of them given, along which boxes of both
/// trees are compared. Unlike a comparison on the axes of one tree, it loses nothing because the
/// other's boxes are rotated: along the line between two points that are close to each other, what
/// is near them has its true distance, and what else lies in their planes is apart on the other
/// two.
class AlignedAxes {
 public:
  /// No axes: no boxes are apart along them.
  AlignedAxes() = default;

  /// The extent along the axes of a box of the first tree, 0, or the second, 1, in its own space.
  [[nodiscard]] Box<double> extent_of(std::size_t tree, const Box<double>& box) const noexcept;
  /// Of a triangle, likewise.
  [[nodiscard]] Box<double> extent_of(std::size_t tree, const Triangle& triangle) const noexcept;
  /// A lower bound of the squared distance between objects with these extents.
  [[nodiscard]] double squared_distance(const Box<double>& first,
                                        const Box<double>& second) const noexcept;

  /// From the first tree's space or the second's.
  [[nodiscard]] const AffineMap& map(std::size_t tree) const noexcept { return map_[tree]; }
  [[nodiscard]] const GapWeights& weights() const noexcept { return weights_; }

 private:
  friend class WorldMetric;

  std::array<AffineMap, 2> map_{{{Eigen::Matrix3d::Zero(), Eigen::Vector3d::Zero()},
                                 {Eigen::Matrix3d::Zero(), Eigen::Vector3d::Zero()}}};
  GapWeights weights_;
};

/// The world in which two trees are placed, in units of a power of two in which G is of size 1.
class WorldMetric {
 public:
  /// Nothing where the magnitudes in a pose are too far apart for any unit.
  static std::optional<WorldMetric> make(const BoundTree& first, const Pose& first_pose,
                                         const BoundTree& second,
                                         const RelativePose& pose) noexcept;

  /// Lower bounds of squared distances of boxes in the first tree's space.
  [[nodiscard]] const GapWeights& in_first() const noexcept { return in_first_; }
  /// The same in the second tree's space: of RelativePose::to_second().hull() and its own boxes.
  [[nodiscard]] const GapWeights& in_second() const noexcept { return in_second_; }

  /// A lower bound of the squared distance of what two boxes hold, each in its tree's space, by
  /// gaps in both spaces. `pose` is that of make().
  [[nodiscard]] double squared_distance(const Box<double>& first, const Box<double>& second,
                                        const RelativePose& pose) const noexcept;

  /// Axes of which the first is along a vector of the world, none if that has no direction. `pose`
  /// is that of make().
  [[nodiscard]] AlignedAxes axes_along(const Eigen::Vector3d& along,
                                       const RelativePose& pose) const noexcept;

  /// An upper bound of the distance of any two points of two boxes in the first tree's space.
  template <class S, class T>
  [[nodiscard]] double farthest(const Box<S>& a, const Box<T>& b) const noexcept {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double max_abs =
          std::max(double{a.high[k]} - double{b.low[k]}, double{b.high[k]} - double{a.low[k]});
      sum += (max_abs * column_[k]) * (max_abs * column_[k]);
    }
    return stretch_ * std::sqrt(sum) + kLengthUnderflow;
  }

  /// Image of a difference of points of the first tree's space.
  [[nodiscard]] Eigen::Vector3d to_world(const Eigen::Vector3d& z) const noexcept {
    Eigen::Vector3d v;
    for (Eigen::Index i = 0; i < 3; ++i) {
      v[i] = (linear_(i, 0) * z[0] + linear_(i, 1) * z[1]) + linear_(i, 2) * z[2];
    }
    return v;
  }
  /// How far the image of a computed difference of two points can be from the true one, per unit of
  /// the largest magnitude in the computed difference.
  [[nodiscard]] double image_error() const noexcept { return image_error_; }

  /// Converts a length in these units to the world's, rounded down or up.
  [[nodiscard]] double length_below(double length) const noexcept;
  [[nodiscard]] double length_above(double length) const noexcept;
  /// Converts a length of the world to these units, rounded down or up.
  [[nodiscard]] double from_world_below(double length) const noexcept;
  [[nodiscard]] double from_world_above(double length) const noexcept;
  [[nodiscard]] int exponent() const noexcept { return exponent_; }

 private:
  Eigen::Matrix3d linear_;  // G in these units
  int exponent_ = 0;        // a unit is 2^exponent
  double image_error_ = 0;
  GapWeights in_first_;
  GapWeights in_second_;
  Eigen::Matrix3d inverse_;         // of G, nearly
  Eigen::Vector3d coordinate_;      // |z_k| / |G z| is at most this; infinite if nothing is known
  Eigen::Vector3d place_;           // largest magnitudes in the first space, of both trees together
  std::array<double, 3> column_{};  // lengths of the columns of G
  double stretch_ = 0;              // of G with columns of length 1, at least
};

}  // namespace boxtree
