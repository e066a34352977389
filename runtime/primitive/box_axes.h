// SPDX-License-Identifier: MIT
// The directions that can separate a box and a triangle (Gottschalk, Lin, Manocha, "OBBTree",
// 1996), in the box's own frame: there its axes are those of coordinates, and what is orthogonal to
// one and to an edge of the triangle is two coordinates of that edge.
#pragma once

#include <cstdint>

#include "runtime/primitive/convex_shape.h"
#include "runtime/primitive/vector3.h"

namespace boxtree {

/// A vector in the frame of a box, and back.
[[nodiscard]] Eigen::Vector3d in_frame_of(const ConvexShape& box,
                                          const Eigen::Vector3d& v) noexcept;
[[nodiscard]] Eigen::Vector3d from_frame_of(const ConvexShape& box,
                                            const Eigen::Vector3d& v) noexcept;

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
  BoxAxes(const ConvexShape& box, const Triangle& triangle, const Corners& corner) noexcept;

  /// How far projections are off, besides twice what the corners are.
  [[nodiscard]] double error() const noexcept { return error_; }

  /// Calls visit(const BoxAxis&) -> bool, whether to go on: with the axes of the box, the normal of
  /// the triangle, and what is orthogonal to an axis and an edge.
  template <class Visitor>
  void visit(const Visitor& visit) const {
    BoxAxis axis;
    for (std::uint32_t n = 0; n < kCount; ++n) {
      if (get(n, axis) && !visit(axis)) return;
    }
  }

 private:
  static constexpr std::uint32_t kCount = 3 + 1 + 3 * 3;

  // Axis n; whether there is one.
  [[nodiscard]] bool get(std::uint32_t n, BoxAxis& axis) const noexcept;

  const ConvexShape& box_;
  const Triangle& triangle_;
  // The edges of the triangle are more accurate than differences of corners in the frame.
  Corners corner_, edge_;
  double error_;
};

}  // namespace boxtree
