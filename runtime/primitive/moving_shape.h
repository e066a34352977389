// SPDX-License-Identifier: MIT
// When a convex shape that moves along a line first touches a triangle.
//
// Every answer rests on one fact: if a direction v separates two convex sets by a gap, and the
// first moves by d per unit of s, then they cannot touch before s = gap / (v . d), whatever the
// error in v. So a time that is found along any direction is a lower bound; what is searched for is
// the direction whose bound is largest.
#pragma once

#include <optional>

#include <boxtree/shape.h>

#include "runtime/primitive/convex_shape.h"
#include "runtime/primitive/penetration.h"
#include "runtime/primitive/triangle.h"

namespace boxtree {

/// A shape on its way: where it starts + s * direction.
struct MovingShape {
  ConvexShape shape;
  Eigen::Vector3d direction;  // its largest component is in [1/2, 1); or zero
  /// How far coordinates of the shape relative to those of triangles may be off, at any s of
  /// interest; see doubt_of().
  double doubt;

  /// `near`: the largest coordinate of triangles, and of the shape while it may touch them;
  /// `far`: of its center at the start.
  [[nodiscard]] static double doubt_of(double near, double far) noexcept;

  [[nodiscard]] Eigen::Vector3d center_at(double s) const noexcept {
    return shape.center + s * direction;
  }

  [[nodiscard]] bool is_box() const noexcept { return shape.axes == 3 && shape.hull == nullptr; }

  struct Touch {
    double s;
    CoreGuess core = CoreGuess::kNone;  // of a capsule: what of it seems to touch
  };
  /// A lower bound of the first s in [from, to] at which the shape touches the triangle; nothing if
  /// it does not, or passes farther away than some `doubt`. Precondition: it does not touch before
  /// `from`, unless `from` is 0.
  [[nodiscard]] std::optional<Touch> first_touch(const Triangle& triangle, double from,
                                                 double to) const noexcept;
  /// Where a shape that stays where it is touches the triangle; nothing exactly where first_touch()
  /// is nothing. Precondition: `direction` is zero.
  [[nodiscard]] std::optional<Penetration> contact_at_rest(const Triangle& triangle) const noexcept;

  struct Contact {
    Eigen::Vector3d point;   // on the triangle
    Eigen::Vector3d normal;  // from it to the shape
    TrianglePart feature;
    double by;  // an s that is not below the first at which they touch
  };
  /// Where they touch at a result of first_touch().
  [[nodiscard]] Contact contact_at(const Triangle& triangle, const Touch& touch) const noexcept;
};

}  // namespace boxtree
