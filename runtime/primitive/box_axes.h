// SPDX-License-Identifier: MIT
// The directions that can separate a box and a triangle (Gottschalk, Lin, Manocha, "OBBTree",
// 1996), in the box's own frame: there its axes are those of coordinates, and what is orthogonal to
// one and to an edge of the triangle is two coordinates of that edge.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/primitive/convex_shape.h"
#include "runtime/primitive/normal.h"
#include "runtime/primitive/rounding.h"
#include "runtime/primitive/separation.h"
#include "runtime/primitive/vector3.h"

namespace boxtree {

/// A box, whose center is the origin, and a triangle along one of them.
struct BoxAxis {
  Eigen::Vector3d along;  // of length 1, in the box's frame
  double low, high;       // of the triangle
  double half;            // of the box
  bool is_more_to_come;   // of the same kind: the axes of the box, the normal, those of one edge
};

class BoxAxes {
 public:
  /// `corner`: of the triangle, relative to the center.
  BoxAxes(const ConvexShape& box, const Triangle& triangle, const Corners& corner) noexcept
      : box_(box), triangle_(triangle) {
    double size = max_abs_of(corner);
    for (const double half : box.half) size = std::max(size, half);
    error_ = kError * size;
    for (std::size_t i = 0; i < 3; ++i) corner_[i] = turned(corner[i]);
  }

  /// How far projections are off, besides twice what the corners are.
  [[nodiscard]] double error() const noexcept { return error_; }

  /// To the box's frame and back.
  [[nodiscard]] Eigen::Vector3d turned(const Eigen::Vector3d& v) const noexcept {
    return {dot(v, box_.axis[0]), dot(v, box_.axis[1]), dot(v, box_.axis[2])};
  }
  [[nodiscard]] Eigen::Vector3d turned_back(const Eigen::Vector3d& v) const noexcept {
    return v[0] * box_.axis[0] + v[1] * box_.axis[1] + v[2] * box_.axis[2];
  }

  /// Calls visit(const BoxAxis&) -> bool, whether to go on: with the axes of the box, the normal of
  /// the triangle, and what is orthogonal to an axis and an edge.
  template <class Visitor>
  void visit(const Visitor& visit) const {
    for (Eigen::Index k = 0; k < 3; ++k) {
      BoxAxis axis{Eigen::Vector3d::Unit(k), corner_[0][k], corner_[0][k],
                   box_.half[static_cast<std::size_t>(k)], k < 2};
      for (std::size_t c = 1; c < 3; ++c) {
        axis.low = std::min(axis.low, corner_[c][k]);
        axis.high = std::max(axis.high, corner_[c][k]);
      }
      if (!visit(axis)) return;
    }
    const Eigen::Vector3d normal = turned(unit_normal(triangle_));
    if (!normal.isZero(0)) {
      const auto [low, high] =
          std::minmax({dot(normal, corner_[0]), dot(normal, corner_[1]), dot(normal, corner_[2])});
      const double half = std::abs(normal[0]) * box_.half[0] + std::abs(normal[1]) * box_.half[1] +
                          std::abs(normal[2]) * box_.half[2];
      if (!visit(BoxAxis{normal, low, high, half, false})) return;
    }
    // The edges of the triangle are more accurate than differences of corners in the frame.
    for (const Eigen::Vector3d& of_triangle : edges_of(triangle_.corner)) {
      const Eigen::Vector3d edge = turned(of_triangle);
      for (Eigen::Index k = 0; k < 3; ++k) {
        const Eigen::Index i = (k + 1) % 3, j = (k + 2) % 3;
        const double square = edge[i] * edge[i] + edge[j] * edge[j];
        if (!(square >= kShortestDirection * kShortestDirection)) continue;
        const double scale = 1 / std::sqrt(square);
        const double on_i = -edge[j] * scale, on_j = edge[i] * scale;
        BoxAxis axis{Eigen::Vector3d::Zero(), 0, 0, 0, k < 2};
        axis.along[i] = on_i;
        axis.along[j] = on_j;
        const auto project = [&](const Eigen::Vector3d& p) { return on_i * p[i] + on_j * p[j]; };
        const auto [low, high] =
            std::minmax({project(corner_[0]), project(corner_[1]), project(corner_[2])});
        axis.low = low;
        axis.high = high;
        axis.half = std::abs(on_i) * box_.half[static_cast<std::size_t>(i)] +
                    std::abs(on_j) * box_.half[static_cast<std::size_t>(j)];
        if (!visit(axis)) return;
      }
    }
  }

 private:
  // The axes are orthonormal to within 4 u. Let R be the largest coordinate of corners and box: one
  // of a corner in the frame is off by 8 u R and by twice what the corner is; the box reaches 16 u
  // R farther along a unit vector than its halves say; a projection and what is subtracted from it
  // round by 16 u R.
  static constexpr double kError = 64 * kRoundoffF64;

  const ConvexShape& box_;
  const Triangle& triangle_;
  Corners corner_;
  double error_;
};

}  // namespace boxtree
