// SPDX-License-Identifier: MIT
// The map from one tree's space to another's, and the box tests in both. Only the six face normals
// are compared, not the nine edge products: those save fewer box visits than they cost.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <boxtree/query.h>

#include "format/box.h"
#include "runtime/primitive/triangle.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree {

/// x -> linear * x + translation, evaluated in one fixed order so that points and boxes round
/// alike.
struct AffineMap {
  Eigen::Matrix3d linear;
  Eigen::Vector3d translation;

  [[nodiscard]] Eigen::Vector3d apply(const Eigen::Vector3d& x) const noexcept {
    Eigen::Vector3d y;
    for (Eigen::Index i = 0; i < 3; ++i) {
      y[i] = ((translation[i] + linear(i, 0) * x[0]) + linear(i, 1) * x[1]) + linear(i, 2) * x[2];
    }
    return y;
  }

  [[nodiscard]] Triangle apply(const Triangle& triangle) const noexcept {
    return {{apply(triangle.corner[0]), apply(triangle.corner[1]), apply(triangle.corner[2])}};
  }

  /// The smallest box that holds the image of `box`. Each bound takes, term by term, the smaller or
  /// larger product; rounding is monotone, so for x inside `box` apply(x) is inside the result, and
  /// the image of a smaller box is inside the image of a larger one: exactly, not just nearly.
  template <class S>
  [[nodiscard]] Box<double> hull(const Box<S>& box) const noexcept {
    Box<double> image;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      double low = translation[row];
      double high = translation[row];
      for (std::size_t j = 0; j < 3; ++j) {
        const double m = linear(row, static_cast<Eigen::Index>(j));
        const double a = m * box.low[j];
        const double b = m * box.high[j];
        low += std::min(a, b);
        high += std::max(a, b);
      }
      image.low[i] = low;
      image.high[i] = high;
    }
    return image;
  }
};

/// Two trees placed in the world, seen from the first one's tree space.
class RelativePose {
 public:
  /// Nothing when a pose is not finite or not invertible.
  static std::optional<RelativePose> make(const BoundTree& first, const Pose& first_pose,
                                          const BoundTree& second,
                                          const Pose& second_pose) noexcept;

  /// Second's tree space to first's: where triangles are compared.
  [[nodiscard]] const AffineMap& to_first() const noexcept { return to_first_; }
  /// Its inverse, as computed, and how far on each axis an image can be off.
  [[nodiscard]] const AffineMap& to_second() const noexcept { return to_second_; }
  [[nodiscard]] const Eigen::Vector3d& to_second_error() const noexcept { return margin_; }

  /// Image of a box of the second tree in first's space.
  template <class S>
  [[nodiscard]] Box<double> hull_in_first(const Box<S>& second) const noexcept {
    return to_first_.hull(second);
  }

  /// Image of a box of the first tree in second's space, widened by the error of the inverse map.
  template <class S>
  [[nodiscard]] Box<double> hull_in_second(const Box<S>& first) const noexcept {
    Box<double> image = to_second_.hull(first);
    for (std::size_t k = 0; k < 3; ++k) {
      const double margin = margin_[static_cast<Eigen::Index>(k)];
      image.low[k] -= margin;
      image.high[k] += margin;
    }
    return image;
  }

 private:
  AffineMap to_first_;
  AffineMap to_second_;
  Eigen::Vector3d margin_;
};

[[nodiscard]] inline Eigen::Vector3d center(const Box<double>& box) noexcept {
  Eigen::Vector3d middle;
  for (std::size_t k = 0; k < 3; ++k) {
    middle[static_cast<Eigen::Index>(k)] = 0.5 * box.low[k] + 0.5 * box.high[k];
  }
  return middle;
}

/// Whether two closed boxes share a point; exact.
template <class S, class T>
[[nodiscard]] bool boxes_overlap(const Box<S>& a, const Box<T>& b) noexcept {
  bool apart = false;
  for (std::size_t k = 0; k < 3; ++k) apart |= a.low[k] > b.high[k] || b.low[k] > a.high[k];
  return !apart;
}

}  // namespace boxtree
