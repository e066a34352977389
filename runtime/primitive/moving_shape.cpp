// SPDX-License-Identifier: MIT
// Spheres and capsules: steps along the line between the closest points (Newton's method on the
// distance, which is a convex function of s, so that no step goes too far; conservative
// advancement, Mirtich, "Impulse-based Dynamic Simulation of Rigid Body Systems", 1996, where
// rounding hides the direction). Boxes: see moving_box.cpp.
#include "runtime/primitive/moving_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/primitive/moving_box.h"
#include "runtime/primitive/normal.h"
#include "runtime/primitive/penetration.h"
#include "runtime/primitive/rounding.h"
#include "runtime/primitive/separation.h"
#include "runtime/primitive/touch_estimate.h"
#include "runtime/primitive/vector3.h"

namespace boxtree {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

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
double longest_length(const Eigen::Vector3d& v) noexcept {
  return std::sqrt(squared_length(v)) * (1 + 4 * kRoundoffF64);
}

// Whether the computed distance is so small that they may touch.
bool may_touch(const MovingShape& moving, const CoreDistance& at) noexcept {
  return at.lower <= moving.shape.radius + 2 * moving.doubt;
}

// Let R be the largest coordinate of corners and shape, |v|_1 the sum of a direction's magnitudes.
// Projections of corners and of a hull's points are off by 3 u |v|_1 R, of a segment by 4 u |v|_1
// R, of a ball by 4 u |v|_1 R, and their sums round by as much.
constexpr double kProjectionError = 16 * kRoundoffF64;

// What a direction from the core to the triangle shows: they are `gap` apart, or less than 0, and
// the shape moves `speed` per unit of s, both in units of its length.
struct Line {
  Line(const MovingShape& moving, const Corners& corner, const Eigen::Vector3d& v) noexcept
      : size((std::abs(v[0]) + std::abs(v[1])) + std::abs(v[2])),
        length(std::sqrt(squared_length(v))),
        speed(dot(v, moving.direction)) {
    const ConvexShape& shape = moving.shape;
    double largest = std::max(max_abs_of(corner), shape.radius);
    for (std::uint32_t i = 0; i < shape.axes; ++i) {
      largest = std::max(largest, shape.half[i] * largest_magnitude(shape.axis[i]));
    }
    const Projection on = project(v, shape, corner);
    double end = on.half;
    if (shape.hull != nullptr) {
      end = -kInfinite;
      for (const Eigen::Vector3d& point : shape.hull->point) end = std::max(end, dot(v, point));
    }
    gap = on.low - end - shape.radius * length - size * (kProjectionError * largest + moving.doubt);
  }

  [[nodiscard]] bool is_direction() const noexcept { return size >= kShortestDirection; }
  [[nodiscard]] bool shows_gap() const noexcept { return is_direction() && gap > 0; }
  // What `speed` may be, rounding included.
  [[nodiscard]] double slowest() const noexcept { return speed - 4 * kRoundoffF64 * size; }
  [[nodiscard]] double fastest() const noexcept { return speed + 4 * kRoundoffF64 * size; }

  double size;  // the sum of its magnitudes
  double length;
  double speed;
  double gap;
};

// The closest points at s, found to within rounding, or those that a guess takes for them.
struct Approach {
  [[gnu::noinline]] Approach(const MovingShape& moving, const Triangle& triangle, double at,
                             CoreGuess guess = CoreGuess::kNone) noexcept
      : s(at),
        corner(placed(moving, triangle, at)),
        points(guessed_points(moving.shape, corner, guess)) {}

  [[nodiscard]] Line line(const MovingShape& moving) const noexcept {
    return {moving, corner, points.between};
  }
  // Whether shape and triangle may touch at s.
  [[nodiscard]] bool may_touch(const MovingShape& moving) const noexcept {
    return points.upper <= moving.shape.radius + 2 * moving.doubt;
  }
  // Whether they may at `other`, near s, as far as these points tell.
  [[nodiscard]] bool may_touch(const MovingShape& moving, const Line& line,
                               double other) const noexcept {
    const double there = std::sqrt(squared_length(points.between + (s - other) * moving.direction));
    const double error = (points.upper - line.length) + 8 * kRoundoffF64 * (line.length + there);
    return there + error <= moving.shape.radius + 2 * moving.doubt;
  }

  double s;
  Corners corner;
  ClosestPoints points;
};

// For where rounding tilts the line between the closest points so that corners cross the gap, as it
// does to one that is short beside a triangle: one orthogonal to the longest edge, or to the face.
[[gnu::noinline]] Line other_line(const MovingShape& moving, const Corners& corner,
                                  const Eigen::Vector3d& between) noexcept {
  const Corners edge = edges_of(corner);
  Eigen::Vector3d longest = edge[0];
  for (const Eigen::Vector3d& e : edge) {
    if (squared_length(e) > squared_length(longest)) longest = e;
  }
  const Line across(moving, corner, orthogonal_to(between, longest, Eigen::Vector3d::Zero()));
  if (across.shows_gap()) return across;
  const Eigen::Vector3d normal = unit_normal({corner});
  const bool is_behind = dot(normal, corner[0]) < 0;
  return {moving, corner, is_behind ? Eigen::Vector3d(-normal) : normal};
}

// Where an approach has led: to `s`, before which nothing touches, whether they may touch there,
// and the closest points there where these tell.
struct Approached {
  MovingShape::Touch at;
  bool is_touch;
  std::optional<ClosestPoints> points;
};

// From an estimate, which a single look may prove, else by steps along the line between the closest
// points; these end where rounding hides the line, or in a touch. Nothing as in first_touch().
std::optional<Approached> approached(const MovingShape& moving, const Triangle& triangle,
                                     double from, double to) noexcept {
  constexpr double kShorten = 1 - 8 * kRoundoffF64;  // what the quotient rounds up
  double s = from;
  TouchEstimate estimate;
  if (!moving.direction.isZero(0)) {
    estimate = estimated_touch(moving.shape, moving.direction, placed(moving, triangle, from));
  }
  if (estimate.s < kInfinite) {
    const Approach look(moving, triangle, from + estimate.s, estimate.core);
    const Line line = look.line(moving);
    if (line.is_direction() && line.slowest() > 0) {
      // The gap was larger before, if it is one; else they do not touch before it was.
      const double by = line.gap > 0 ? line.gap / line.fastest() * kShorten
                                     : line.gap / line.slowest() * (1 + 8 * kRoundoffF64);
      s = std::max(from, look.s + by);
      if (s > to) return std::nullopt;
      if (look.may_touch(moving, line, s)) {
        return Approached{{s, estimate.core}, true, std::nullopt};
      }
    }
  }
  for (int step = 0; step < kMostSteps; ++step) {
    const Approach look(moving, triangle, s);
    if (look.may_touch(moving)) return Approached{{s}, true, look.points};
    Line line = look.line(moving);
    if (!line.shows_gap()) line = other_line(moving, look.corner, look.points.between);
    if (!line.shows_gap()) break;
    if (!(line.fastest() > 0)) return std::nullopt;  // it moves away from the gap
    const double next = s + line.gap / line.fastest() * kShorten;
    if (!(next > s)) break;
    s = next;
    if (s > to) return std::nullopt;
  }
  return Approached{{s}, false, std::nullopt};
}

// From `from` on, before which nothing touches.
std::optional<MovingShape::Touch> first_touch_by_distance(const MovingShape& moving,
                                                          const Triangle& triangle, double from,
                                                          double to) noexcept {
  constexpr double kShorten = 1 - 8 * kRoundoffF64;  // what the divisions and sums round up
  const double reach = moving.shape.radius + moving.doubt;
  double s = from;
  for (int step = 0; step < kMostSteps; ++step) {
    const Corners corner = placed(moving, triangle, s);
    const CoreDistance at = core_distance(moving.shape, corner);
    if (may_touch(moving, at)) return MovingShape::Touch{s};
    // Nothing comes nearer by more than it moves.
    double advance = (at.lower - reach) / longest_length(moving.direction);
    if (at.along > reach) {
      const double speed = speed_along(at.apart, moving.direction);
      if (!(speed > 0)) return std::nullopt;  // it moves away from the gap
      advance = std::max(advance, (at.along - reach) * std::sqrt(squared_length(at.apart)) / speed);
    } else if (const Line line = other_line(moving, corner, at.between); line.shows_gap()) {
      if (!(line.fastest() > 0)) return std::nullopt;
      advance = std::max(advance, line.gap / line.fastest());
    }
    const double next = s + advance * kShorten;
    if (!(next > s)) return MovingShape::Touch{s};
    s = next;
    if (s > to) return std::nullopt;
  }
  return MovingShape::Touch{s};
}

std::optional<MovingShape::Touch> first_touch_of_core(const MovingShape& moving,
                                                      const Triangle& triangle, double from,
                                                      double to) noexcept {
  const std::optional<Approached> quick = approached(moving, triangle, from, to);
  if (!quick) return std::nullopt;
  if (quick->is_touch) return quick->at;
  return first_touch_by_distance(moving, triangle, quick->at.s, to);
}

// What is known of how near a core and a triangle are.
struct Nearness {
  Eigen::Vector3d between;
  double length;  // of `between`
  double lower, upper;
};

Nearness nearness_of(const ClosestPoints& at) noexcept {
  const double length = std::sqrt(squared_length(at.between));
  return {at.between, length, 2 * length - at.upper, at.upper};
}

Nearness nearness(const MovingShape& moving, const Corners& corner, CoreGuess guess) noexcept {
  if (moving.shape.hull != nullptr) {
    const CoreDistance at = core_distance(moving.shape, corner);
    return {at.between, at.length, at.lower, at.upper};
  }
  return nearness_of(contact_points(moving.shape, corner, guess));
}

// From a touch on, where they are `at`: when it is certain that they touch, or when the distance
// does not fall any more.
double certain_by(const MovingShape& moving, const Triangle& triangle,
                  const MovingShape::Touch& touch, Nearness at,
                  const Eigen::Vector3d& normal) noexcept {
  const double doubt = moving.doubt, radius = moving.shape.radius;
  // A distance tells no more how deep a hull is, nor a core that has next to nothing around it.
  const bool is_core = moving.shape.hull != nullptr || radius <= 8 * doubt;
  const double way = longest_length(moving.direction);
  double by = touch.s, step = 0;
  double passed = kInfinite;  // a step after which it is apart again
  for (int n = 0; n < kMostSteps; ++n) {
    const double missing = at.upper + doubt - radius;
    // Rounding tilts the line between points that are near each other, but no normal.
    const bool is_last = is_core && at.length <= radius + 8 * doubt;
    const double speed =
        is_last ? -dot(normal, moving.direction) : dot(at.between, moving.direction);
    // What rounding alone makes of a shape that slides along the triangle.
    const double tilt = is_last ? 0 : (at.upper - at.length + doubt) * way;
    if (!(missing > 0) || !(speed > tilt)) break;
    double next = is_last ? step + (at.length + 2 * doubt) / speed
                          : std::max(2 * step, 2 * missing * at.length / speed);
    if (!(next < passed)) next = step + (passed - step) / 2;
    const Nearness there = nearness(moving, placed(moving, triangle, touch.s + next), touch.core);
    if (there.lower > radius + 6 * doubt) {  // it has passed the triangle, or a corner
      if (is_last) break;
      passed = next;
      continue;
    }
    at = there;
    step = next;
    by = touch.s + step;
    if (is_last) break;
  }
  return by;
}

MovingShape::Contact contact_of_hull(const MovingShape& moving, const Triangle& triangle,
                                     const MovingShape::Touch& touch) noexcept {
  const ConvexShape& shape = moving.shape;
  const Corners corner = placed(moving, triangle, touch.s);
  const Penetration found = touch.s > 0 ? shape.hull->penetration(shape.hull->point, corner,
                                                                  moving.doubt, &moving.direction)
                                        : penetration(shape, corner, moving.doubt);
  return {moving.center_at(touch.s) + found.point, found.normal, found.feature,
          certain_by(moving, triangle, touch, nearness(moving, corner, touch.core), found.normal)};
}

MovingShape::Contact contact_of_core(const MovingShape& moving, const Triangle& triangle,
                                     const MovingShape::Touch& touch) noexcept {
  const Corners corner = placed(moving, triangle, touch.s);
  const ClosestPoints at = contact_points(moving.shape, corner, touch.core);
  const Penetration found = penetration_of_core(moving.shape, corner, moving.doubt, at);
  return {moving.center_at(touch.s) + found.point, found.normal, found.feature,
          certain_by(moving, triangle, touch, nearness_of(at), found.normal)};
}

}  // namespace

// A center at s is off by u of s * direction, which is at most as long as both, and u of itself;
// its difference from a corner by u of that; and the direction, scaled to tree space, not at all.
double MovingShape::doubt_of(double near, double far) noexcept {
  return (16 * near + 4 * far) * kRoundoffF64;
}

std::optional<MovingShape::Touch> MovingShape::first_touch(const Triangle& triangle, double from,
                                                           double to) const noexcept {
  if (is_box()) return first_touch_of_box(*this, triangle, from, to);
  return shape.hull != nullptr ? first_touch_by_distance(*this, triangle, from, to)
                               : first_touch_of_core(*this, triangle, from, to);
}

std::optional<Penetration> MovingShape::contact_at_rest(const Triangle& triangle) const noexcept {
  const Corners corner = placed(*this, triangle, 0);
  if (is_box()) return box_penetration(shape, triangle, corner, doubt);
  std::optional<ClosestPoints> points;
  if (shape.hull == nullptr) {
    const std::optional<Approached> found = approached(*this, triangle, 0, 0);
    if (!found) return std::nullopt;
    points = found->points;
  }
  if (!points && !first_touch_by_distance(*this, triangle, 0, 0)) return std::nullopt;
  if (shape.hull != nullptr) return penetration(shape, corner, doubt);
  return penetration_of_core(
      shape, corner, doubt,
      points ? contact_points(shape, corner, *points) : contact_points(shape, corner));
}

MovingShape::Contact MovingShape::contact_at(const Triangle& triangle,
                                             const Touch& touch) const noexcept {
  if (is_box()) return contact_of_box(*this, triangle, touch.s);
  return shape.hull != nullptr ? contact_of_hull(*this, triangle, touch)
                               : contact_of_core(*this, triangle, touch);
}

}  // namespace boxtree
