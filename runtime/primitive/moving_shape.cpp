// SPDX-License-Identifier: MIT
// Spheres and capsules: steps along the line between the closest points (Newton's method on the
// distance, which is a convex function of s, so that no step goes too far; conservative
// advancement, Mirtich, "Impulse-based Dynamic Simulation of Rigid Body Systems", 1996, where
// rounding hides the direction). Boxes: all directions that can separate a box and a triangle, each
// with the interval of s in which it does not (Gottschalk, Lin, Manocha, "OBBTree", 1996, in time).
#include "runtime/primitive/moving_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/primitive/normal.h"
#include "runtime/primitive/penetration.h"
#include "runtime/primitive/rounding.h"
#include "runtime/primitive/separation.h"
#include "runtime/primitive/vector3.h"

namespace boxtree {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Each step at least halves what is left where the shape grazes the triangle, and squares it
// elsewhere: after so many nothing that double resolves is left.
constexpr int kMostSteps = 64;

// The corners of a triangle relative to the shape's center at s.
Corners placed(const MovingShape& moving, const Triangle& triangle, double s) noexcept {
  return relative_to(moving.center_at(s), triangle);
}

// An upper bound of how fast the shape moves along v, per unit of s.
double speed_along(const Eigen::Vector3d& v, const Eigen::Vector3d& direction) noexcept {
  const double size = (std::abs(v[0]) + std::abs(v[1])) + std::abs(v[2]);
  return dot(v, direction) + 4 * kRoundoffF64 * size;
}

// Of a vector whose components are at most 1, rounded up.
double length_above(const Eigen::Vector3d& v) noexcept {
  return std::sqrt(squared_length(v)) * (1 + 4 * kRoundoffF64);
}

// Whether the computed distance is so small that they may touch.
bool may_touch(const MovingShape& moving, const CoreDistance& at) noexcept {
  return at.lower <= moving.shape.radius + 2 * moving.doubt;
}

// A lower bound of when a core comes that near to the triangle's plane; infinity for never. It is
// that of the triangle where its inside is touched. Precondition: as of first_touch.
double plane_touch(const MovingShape& moving, const Triangle& triangle, double from,
                   double reach) noexcept {
  const Corners corner = placed(moving, triangle, from);
  const Eigen::Vector3d n = cross(corner[1] - corner[0], corner[2] - corner[0]);
  const double length = std::sqrt(squared_length(n));
  // Any vector will do, so that only what follows is rounded; of one that is too short to be a
  // direction nothing follows.
  if (!(length >= kShortestDirection)) return from;
  const auto [low, high, half] = project(n, moving.shape, corner);
  // Relative to the length, as in separation_along.
  const double error = kSeparationError * 2 * (max_abs_of(corner) + half / length);
  const double speed = dot(n, moving.direction) / length;
  constexpr double kSpeedError = 8 * kRoundoffF64;
  const double ahead = std::max((low - half) / length, -(high + half) / length);
  const bool is_behind = (low - half) < -(high + half);
  const double gap = ahead - reach - 2 * error;
  if (!(gap > 0)) return from;
  const double toward = (is_behind ? -speed : speed) + kSpeedError;
  return toward > 0 ? from + gap / toward * (1 - 8 * kRoundoffF64) : kInfinity;
}

std::optional<double> first_touch_of_core(const MovingShape& moving, const Triangle& triangle,
                                          double from, double to) noexcept {
  constexpr double kShorten = 1 - 8 * kRoundoffF64;  // what the divisions and sums round up
  const double reach = moving.shape.radius + moving.doubt;
  // A hull's first step is along a normal, too, where it touches a face.
  const bool has_center = moving.shape.hull == nullptr;
  double s = has_center ? std::max(from, plane_touch(moving, triangle, from, reach)) : from;
  if (s > to || s == kInfinity) return std::nullopt;
  for (int step = 0; step < kMostSteps; ++step) {
    const CoreDistance at = core_distance(moving.shape, placed(moving, triangle, s));
    if (may_touch(moving, at)) return s;
    // Nothing comes nearer by more than it moves.
    double advance = (at.lower - reach) / length_above(moving.direction);
    if (at.along > reach) {
      const double speed = speed_along(at.between, moving.direction);
      if (!(speed > 0)) return std::nullopt;  // it moves away from the gap
      advance = std::max(advance, (at.along - reach) * at.length / speed);
    }
    const double next = s + advance * kShorten;
    if (!(next > s)) return s;
    s = next;
    if (s > to) return std::nullopt;
  }
  return s;
}

// One direction that may separate a box and a triangle: where their projections overlap.
class Axes {
 public:
  Axes(const MovingShape& moving, const Corners& corner) noexcept
      : moving_(moving), corner_(corner) {
    const ConvexShape& shape = moving.shape;
    double size = max_abs_of(corner);
    for (const double half : shape.half) size = std::max(size, half);
    // Unit vectors within 4 u on each axis: three projections of corners, four of the box.
    error_ = 32 * kRoundoffF64 * size + 2 * moving.doubt;
  }

  // Along a vector of length 1, or 0: then it is no direction.
  void try_axis(const Eigen::Vector3d& axis) noexcept {
    if (axis.isZero(0)) return;
    const auto [low, high, half] = project(axis, moving_.shape, corner_);
    // They overlap while first <= s * speed <= last.
    const double first = low - half, last = high + half;
    const double speed = dot(axis, moving_.direction);
    if (speed < 0) {
      try_interval(-last, -first, -speed, axis);
    } else {
      try_interval(first, last, speed, -axis);
    }
  }

  // Ends early where first_touch() is nothing.
  void try_all(double from = 0, double to = kInfinity) noexcept {
    const Corners edge = edges_of(corner_);
    for (const Eigen::Vector3d& axis : moving_.shape.axis) try_axis(axis);
    if (!first_touch(from, to)) return;
    try_axis(unit_normal({corner_}));
    if (!first_touch(from, to)) return;
    for (const Eigen::Vector3d& of_triangle : edge) {
      for (const Eigen::Vector3d& of_box : moving_.shape.axis) {
        try_axis(unit_normal({{Eigen::Vector3d::Zero(), of_triangle, of_box}}));
        if (!first_touch(from, to)) return;
      }
    }
  }

  // By the axes so far, of a shape that is where it is at `from`.
  [[nodiscard]] std::optional<double> first_touch(double from, double to) const noexcept {
    const double s = from + enter * (1 - 8 * kRoundoffF64);
    return enter <= leave && s <= to ? std::optional(s) : std::nullopt;
  }

  double enter = 0;          // they do not touch before
  double leave = kInfinity;  // nor after
  double enter_by = 0;       // they touch by then, if at all
  // Of the axes along which they come nearer, that along which they overlap least: by how much, or
  // less than 0 where it is a gap, and the direction from the triangle to the box. Of equal ones
  // those of the box, then the normal of the face.
  double overlap = kInfinity;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  /// How far projections are off.
  [[nodiscard]] double error() const noexcept { return error_; }

 private:
  // How far speeds along a unit vector are off.
  static constexpr double kSpeedError = 16 * kRoundoffF64;

  // `speed` is not negative; `back`: the axis, against the motion.
  void try_interval(double first, double last, double speed, const Eigen::Vector3d& back) noexcept {
    const double slowest = speed - kSpeedError;
    if (slowest > 0 && -first < overlap - 2 * error_) {
      overlap = -first;
      normal = back;
    }
    if (first > error_) {  // ahead
      enter = std::max(enter, (first - error_) / (speed + kSpeedError));
      enter_by = std::max(enter_by, slowest > 0 ? (first + error_) / slowest : kInfinity);
    } else if (first > -error_ && slowest > 0) {
      enter_by = std::max(enter_by, (first + error_) / slowest);
    }
    if (last < -error_) {
      leave = -1;  // behind
    } else if (slowest > 0) {
      leave = std::min(leave, (last + error_) / slowest);
    }
  }

  const MovingShape& moving_;
  const Corners& corner_;
  double error_;
};

std::optional<double> first_touch_of_box(const MovingShape& moving, const Triangle& triangle,
                                         double from, double to) noexcept {
  const Corners corner = placed(moving, triangle, from);
  Axes axes(moving, corner);
  axes.try_all(from, to);
  return axes.first_touch(from, to);
}

MovingShape::Contact contact_of_box(const MovingShape& moving, const Triangle& triangle,
                                    double s) noexcept {
  const Corners corner = placed(moving, triangle, s);
  Axes axes(moving, corner);
  axes.try_all();
  MovingShape::Contact contact;
  const double error = 2 * axes.error();
  contact.by = s + std::min(axes.enter_by, std::max(axes.leave, 0.0)) * (1 + 8 * kRoundoffF64);
  contact.point = moving.center_at(s) + point_inside_box(moving.shape, error, corner);
  if (!(axes.overlap <= 2 * error)) {  // they have overlapped from the start on
    const Penetration start = penetration(moving.shape, corner, moving.doubt);
    contact.normal = start.normal;
    contact.feature = start.feature;
    return contact;
  }
  contact.normal = axes.normal;
  contact.feature = farthest_feature(contact.normal, corner, 2 * error);
  return contact;
}

}  // namespace

// A center at s is off by u of s * direction, which is at most as long as both, and u of itself;
// its difference from a corner by u of that; and the direction, scaled to tree space, not at all.
double MovingShape::doubt_of(double near, double far) noexcept {
  return (16 * near + 4 * far) * kRoundoffF64;
}

std::optional<double> MovingShape::first_touch(const Triangle& triangle, double from,
                                               double to) const noexcept {
  return is_box() ? first_touch_of_box(*this, triangle, from, to)
                  : first_touch_of_core(*this, triangle, from, to);
}

MovingShape::Contact MovingShape::contact_at(const Triangle& triangle, double s) const noexcept {
  if (is_box()) return contact_of_box(*this, triangle, s);
  const Corners corner = placed(*this, triangle, s);
  const Penetration found =
      shape.hull != nullptr && s > 0
          ? shape.hull->penetration(shape.hull->point, corner, doubt, &direction)
          : penetration(shape, corner, doubt);
  Contact contact{center_at(s) + found.point, found.normal, found.feature, s};
  // Until it is certain that they touch, or the distance does not fall any more.
  CoreDistance at = core_distance(shape, corner);
  double step = 0;
  for (int n = 0; n < kMostSteps; ++n) {
    const double missing = at.upper + doubt - shape.radius;
    // Rounding tilts the line between points that are near each other, but no normal of a hull.
    const bool is_last = shape.hull != nullptr && at.length <= 8 * doubt;
    const double speed = is_last ? -dot(found.normal, direction) : dot(at.between, direction);
    if (!(missing > 0) || !(speed > 0)) break;
    step = is_last ? step + (at.length + 2 * doubt) / speed
                   : std::max(2 * step, 2 * missing * at.length / speed);
    at = core_distance(shape, placed(*this, triangle, s + step));
    if (is_last && at.lower > 6 * doubt) break;  // it has passed a corner
    contact.by = s + step;
    if (is_last) break;
  }
  return contact;
}

}  // namespace boxtree
