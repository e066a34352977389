// SPDX-License-Identifier: MIT
// All directions that can separate a box and a triangle, each with the interval of s in which it
// does not (Gottschalk, Lin, Manocha, "OBBTree", 1996, in time).
#include "runtime/primitive/moving_box.h"

#include <algorithm>
#include <limits>

#include "runtime/primitive/axis_lanes.h"
#include "runtime/primitive/box_axes.h"
#include "runtime/primitive/penetration.h"
#include "runtime/primitive/rounding.h"
#include "runtime/primitive/vector3.h"

namespace boxtree {
namespace {

// How far speeds along a unit vector are off.
constexpr double kBoxSpeedError = 16 * kRoundoffF64;

// From when to when they may touch, by the axes so far.
struct Interval {
  // What is rounded away from each other: a quotient of what is not ahead is no more than 0, and
  // one by no speed infinite, or NaN, which is not less than `leave`.
  [[gnu::noinline]] void cut(const BoxOverlaps& axes, double error) noexcept {
    AxisLanes sooner, later;
    for (std::size_t k = 0; k < AxisLanes::kCount; ++k) {
      const double slowest = axes.speed[k] - kBoxSpeedError;
      sooner[k] = (axes.first[k] - error) / (axes.speed[k] + kBoxSpeedError);
      later[k] = (axes.last[k] + error) / (slowest > 0 ? slowest : 0);
    }
    for (std::size_t k = 0; k < AxisLanes::kCount; ++k) {
      enter = std::max(enter, sooner[k]);
      leave = std::min(leave, later[k]);
    }
  }

  double enter = 0;                                        // they do not touch before
  double leave = std::numeric_limits<double>::infinity();  // nor after
};

}  // namespace

std::optional<MovingShape::Touch> first_touch_of_box(const MovingShape& moving,
                                                     const Triangle& triangle, double from,
                                                     double to) noexcept {
  BoxAxes axes(moving.shape, triangle, relative_to(moving.center_at(from), triangle),
               moving.direction);
  const double error = axes.error() + 2 * moving.doubt;
  Interval interval;
  double s = from;
  for (std::size_t group = 0; group < BoxAxes::kGroups; ++group) {
    interval.cut(axes.overlaps(group), error);
    s = from + interval.enter * (1 - 8 * kRoundoffF64);
    if (!(interval.enter <= interval.leave && s <= to)) return std::nullopt;
  }
  return MovingShape::Touch{s};
}

MovingShape::Contact contact_of_box(const MovingShape& moving, const Triangle& triangle,
                                    double s) noexcept {
  const Corners corner = relative_to(moving.center_at(s), triangle);
  BoxAxes axes(moving.shape, triangle, corner, moving.direction);
  const double error = axes.error() + 2 * moving.doubt;
  Interval interval;
  double enter_by = 0;  // they touch by then, if at all
  // Of the axes along which they come nearer, that along which they overlap least: by how much, or
  // less than 0 where it is a gap. Of equal ones those of the box, then the normal of the face.
  double overlap = std::numeric_limits<double>::infinity();
  Eigen::Vector3d back = Eigen::Vector3d::Zero();  // from the triangle to the box, in its frame
  for (std::size_t group = 0; group < BoxAxes::kGroups; ++group) {
    const BoxOverlaps overlaps = axes.overlaps(group);
    interval.cut(overlaps, error);
    for (std::size_t k = 0; k < BoxAxes::count(group); ++k) {
      const double first = overlaps.first[k], slowest = overlaps.speed[k] - kBoxSpeedError;
      if (slowest > 0) {
        if (-first < overlap - 2 * error) {
          overlap = -first;
          back = overlaps.against[k] * axes.axis(group, k);
        }
        enter_by = std::max(enter_by, (first + error) / slowest);
      } else if (first > error) {
        enter_by = std::numeric_limits<double>::infinity();
      }
    }
    if (!(interval.enter <= interval.leave)) break;
  }
  MovingShape::Contact contact;
  contact.by = s + std::min(enter_by, std::max(interval.leave, 0.0)) * (1 + 8 * kRoundoffF64);
  contact.point = moving.center_at(s) + point_inside_box(moving.shape, 2 * error, corner);
  if (!(overlap <= 4 * error)) {  // they have overlapped from the start on
    const Penetration start = penetration(moving.shape, corner, moving.doubt);
    contact.normal = start.normal;
    contact.feature = start.feature;
    return contact;
  }
  contact.normal = from_frame_of(moving.shape, back);
  contact.feature = farthest_feature(contact.normal, corner, 4 * error);
  return contact;
}

}  // namespace boxtree
