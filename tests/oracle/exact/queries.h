// SPDX-License-Identifier: MIT
// Positions, boxes and lengths near the features of a mesh.
#pragma once

#include <boxtree/boxtree.h>

#include "tests/oracle/exact/draw.h"
#include "tests/oracle/exact/subject.h"

namespace boxtree::oracle {

/// The largest error of distances, in units in the last place of the largest coordinate involved.
inline constexpr double kUlps = 16;
/// The least unit, in tree space: sixteen are the 2^-500 to which distances are resolved.
inline constexpr double kResolution = 0x1p-504;

/// A position of object space: on a corner, an edge, a face, off it by an ulp or more, far away, or
/// of any exponents.
struct Position {
  Eigen::Vector3d at;
  const Decoded* aimed;  // at this triangle
};
[[nodiscard]] Position draw_position(Draw& draw, const Group& group);

/// About the distance of that position from the triangle at which it aims, or from another, in
/// object space: rounded, by some ulps more or less, or any part of it.
[[nodiscard]] double draw_length(Draw& draw, const Group& group, const Position& position);

/// A box of object space: points, ulps wide, flat, touching a face with one corner, beside its
/// bounds, around much of the mesh.
[[nodiscard]] Eigen::AlignedBox3d draw_box(Draw& draw, const Group& group);

[[nodiscard]] inline Point point_of(const Eigen::Vector3d& v) {
  return {v[0], v[1], v[2]};
}
/// Where a frame brings a position: one rounded subtraction and one scaling on each axis.
[[nodiscard]] Point to_tree(const Frame& frame, const Eigen::Vector3d& object);
/// The same without rounding.
[[nodiscard]] ExactPoint to_tree_exactly(const Frame& frame, const Eigen::Vector3d& object);
[[nodiscard]] inline int exponent_of(const Frame& frame) {
  return std::ilogb(frame.scale);
}

/// |reported - exact| in units, where exact is a root.
[[nodiscard]] double error_in_units(const Dyadic& reported, const Quotient& exact_square,
                                    double unit);
/// Whether length <= root of square; exact. Precondition: the square is not negative.
[[nodiscard]] bool is_at_most(const Dyadic& length, const Quotient& square);
/// A root as a double, rounded toward zero.
[[nodiscard]] double root_below(const Quotient& square);

/// The decoded triangle of an answer; null where there is none.
[[nodiscard]] const Decoded* find(const Group& group, std::uint32_t face, std::uint32_t half);

}  // namespace boxtree::oracle
