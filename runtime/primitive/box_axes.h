// SPDX-License-Identifier: MIT
// The directions that can separate a box and a triangle (Gottschalk, Lin, Manocha, "OBBTree",
// 1996), in the box's own frame: there its axes are those of coordinates, and what is orthogonal to
// one and to an edge of the triangle is two coordinates of that edge. In four groups, so that those
// of a group are computed together: the axes of the box with the normal of the triangle, and what
// is orthogonal to an axis of the box and one edge.
#pragma once

#include <array>
#include <cstddef>

#include "runtime/primitive/axis_lanes.h"
#include "runtime/primitive/convex_shape.h"
#include "runtime/primitive/vector3.h"

namespace boxtree {

/// A vector in the frame of a box, and back.
[[nodiscard]] Eigen::Vector3d in_frame_of(const ConvexShape& box,
                                          const Eigen::Vector3d& v) noexcept;
[[nodiscard]] Eigen::Vector3d from_frame_of(const ConvexShape& box,
                                            const Eigen::Vector3d& v) noexcept;

/// Along the axes of a group, of length 1: a box and a triangle overlap while first <= s * speed <=
/// last. Infinite both ways where there is no axis.
struct BoxOverlaps {
  /// By a, b, c, the corners of the triangle relative to the center of the box, which reaches
  /// `half` to either side of it and moves by `moved`.
  [[gnu::noinline]] BoxOverlaps(const AxisLanes& a, const AxisLanes& b, const AxisLanes& c,
                                const AxisLanes& half, const AxisLanes& moved) noexcept;

  /// Makes a lane one without an axis.
  void drop(std::size_t lane) noexcept;

  AxisLanes first, last, speed;
  AxisLanes against;  // times the axis: against the motion
};

class BoxAxes {
 public:
  static constexpr std::size_t kGroups = 4;

  /// `corner`: of the triangle, relative to the center. `direction`: of the box, per unit of s.
  BoxAxes(const ConvexShape& box, const Triangle& triangle, const Corners& corner,
          const Eigen::Vector3d& direction) noexcept;

  /// How far projections are off, besides twice what the corners are.
  [[nodiscard]] double error() const noexcept { return error_; }

  [[nodiscard]] BoxOverlaps overlaps(std::size_t group) noexcept;
  /// How many lanes of a group have axes of their own.
  [[nodiscard]] static std::size_t count(std::size_t group) noexcept { return group == 0 ? 4 : 3; }
  /// The axis in a lane, in the box's frame, of the group whose overlaps were computed last.
  [[nodiscard]] Eigen::Vector3d axis(std::size_t group, std::size_t lane) const noexcept;

 private:
  // Vectors in the frame of the box, as in_frame_of() rounds them.
  class Frame {
   public:
    explicit Frame(const ConvexShape& box) noexcept;
    [[nodiscard]] AxisLanes operator()(const Eigen::Vector3d& v) const noexcept;

   private:
    AxisLanes x_, y_, z_;
  };

  // What axes see of a vector that are orthogonal to coordinate k: the next coordinate and the one
  // after that.
  struct Turned {
    Turned() noexcept = default;  // unspecified numbers
    explicit Turned(const AxisLanes& v) noexcept
        : next(v[1], v[2], v[0]), after(v[2], v[0], v[1]) {}

    AxisLanes next, after;
  };
  [[nodiscard]] static AxisLanes sum_of_products(const Turned& a, const Turned& b) noexcept;

  [[nodiscard]] BoxOverlaps along_axes_and_normal() noexcept;
  [[nodiscard]] BoxOverlaps across_edge(const Eigen::Vector3d& of_triangle) noexcept;

  Frame frame_;
  const Triangle& triangle_;
  double error_;
  std::array<AxisLanes, 3> corner_;
  AxisLanes half_, direction_;
  std::array<Turned, 3> turned_corner_;
  Turned turned_half_, turned_direction_;
  Eigen::Vector3d normal_;  // of group 0
  Turned along_;            // of the other groups
};

}  // namespace boxtree
