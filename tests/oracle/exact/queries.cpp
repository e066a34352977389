// SPDX-License-Identifier: MIT
// Queries aimed at features.
#include "tests/oracle/exact/queries.h"

#include <algorithm>
#include <cmath>

#include "tests/oracle/exact/poses.h"

namespace boxtree::oracle {
namespace {

double size_of(const Decoded& t) {
  double size = 0;
  for (std::size_t k = 0; k < 3; ++k) size = std::max(size, t.bounds.high[k] - t.bounds.low[k]);
  return size;
}

const Decoded& draw_triangle(Draw& d, const Group& group) {
  return group.triangles[d.below(static_cast<std::uint32_t>(group.triangles.size()))];
}

Eigen::Vector3d to_object(const Group& group, const Point& p) {
  return group.frame().to_object(Eigen::Vector3d(p[0], p[1], p[2]));
}

double finite(double x) {
  return std::clamp(x, -std::numeric_limits<double>::max(), std::numeric_limits<double>::max());
}

// A direction that a box's corner may point into against the face.
Point normal_of(const Face& t) {
  return cross(minus(t[1], t[0]), minus(t[2], t[0]));
}

Eigen::Vector3d nudged(Draw& d, Eigen::Vector3d p) {
  for (Eigen::Index k = 0; k < 3; ++k) p[k] = d.nudged(p[k]);
  return p;
}

void set(Eigen::AlignedBox3d& box, Eigen::Index k, double a, double b) {
  box.min()[k] = finite(std::min(a, b));
  box.max()[k] = finite(std::max(a, b));
}

// The box has its corner at a position on a face and lies on one side of it.
Eigen::AlignedBox3d corner_on_face(Draw& d, const Group& group, double side) {
  const Decoded& t = draw_triangle(d, group);
  Eigen::Vector3d at = to_object(group, draw_point_on(d, t.at));
  if (d.one_in(2)) at = nudged(d, at);
  const Point n = normal_of(t.at);
  Eigen::AlignedBox3d box;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const bool up = n[static_cast<std::size_t>(k)] >= 0;
    set(box, k, at[k], at[k] + (up ? side : -side));
  }
  return box;
}

// Beside the bounds of a face on one axis: touching, or apart by an ulp.
Eigen::AlignedBox3d beside_bounds(Draw& d, const Group& group, double side) {
  const Decoded& t = draw_triangle(d, group);
  const Eigen::Vector3d low = to_object(group, t.bounds.low);
  const Eigen::Vector3d high = to_object(group, t.bounds.high);
  Eigen::AlignedBox3d box;
  for (Eigen::Index k = 0; k < 3; ++k) set(box, k, low[k], high[k]);
  const Eigen::Index axis = d.below(3);
  if (d.one_in(2)) {
    set(box, axis, d.nudged(high[axis]), d.nudged(high[axis]) + side);
  } else {
    set(box, axis, d.nudged(low[axis]), d.nudged(low[axis]) - side);
  }
  return box;
}

}  // namespace

Position draw_position(Draw& d, const Group& group) {
  const Decoded& t = draw_triangle(d, group);
  Point p = t.at[d.below(3)];
  const auto kind = d.below(10);
  if (kind >= 2) p = draw_point_on(d, t.at);
  if (kind >= 5 && kind <= 7) {  // off the face by some part of its size
    const double away = size_of(t) * d.power(kind == 5 ? -60 : -6, 2);
    for (double& x : p) x += d.unit() * away;
  }
  if (kind == 8) {
    const double away = d.power(14, d.one_in(4) ? 200 : 40);
    for (double& x : p) x = d.unit() * away;
  }
  Eigen::Vector3d object = to_object(group, p);
  if (kind == 9) {
    const int top = std::min(1000, exponent_of(group.frame()) + 40);
    for (Eigen::Index k = 0; k < 3; ++k) object[k] = d.any_f64(-1074, top);
  }
  if (d.one_in(3)) object = nudged(d, object);
  for (Eigen::Index k = 0; k < 3; ++k) {
    object[k] = finite(object[k]);
    if (d.one_in(60)) object[k] = d.sign() * std::numeric_limits<double>::denorm_min();
    if (d.one_in(60)) object[k] = d.sign() * 0.0;
  }
  return {object, &t};
}

double draw_length(Draw& d, const Group& group, const Position& position) {
  const Decoded& t = d.one_in(4) ? draw_triangle(d, group) : *position.aimed;
  const Frame& frame = group.frame();
  const Point at = to_tree(frame, position.at);
  const double distance = root_below(squared_distance(as<Dyadic>(at), t.exact));
  const double unit = ulp_of(std::max(t.largest, largest(at)));
  switch (d.below(8)) {
    case 0:
      return 0;
    case 1:
    case 2:
      return distance * 2 * d.part() * frame.scale;
    case 3:
    case 4:
      return std::abs(d.nudged(distance)) * frame.scale;
    default:  // as near as an answer must tell
      return std::abs(distance + d.sign() * (kUlps + d.power(0, 10)) * unit) * frame.scale;
  }
}

Eigen::AlignedBox3d draw_box(Draw& d, const Group& group) {
  const double scale = group.frame().scale;
  const double side = size_of(draw_triangle(d, group)) * scale * d.power(-60, 3) * (0.5 + d.part());
  const auto kind = d.below(8);
  if (kind < 2) return corner_on_face(d, group, side);
  if (kind == 2) return beside_bounds(d, group, side);
  const Eigen::Vector3d at = draw_position(d, group).at;
  Eigen::AlignedBox3d box(at, at);
  if (kind == 3) return box;
  if (kind == 4) {  // ulps wide
    for (Eigen::Index k = 0; k < 3; ++k) set(box, k, at[k], d.nudged(at[k]));
    return box;
  }
  if (kind == 5) {  // any two positions
    const Eigen::Vector3d to = draw_position(d, group).at;
    for (Eigen::Index k = 0; k < 3; ++k) set(box, k, at[k], to[k]);
    return box;
  }
  for (Eigen::Index k = 0; k < 3; ++k) {
    set(box, k, at[k] - side * d.part(), at[k] + side * d.part());
    if (d.one_in(4)) set(box, k, at[k], at[k]);
  }
  return box;
}

Point to_tree(const Frame& frame, const Eigen::Vector3d& object) {
  Point p;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    p[k] = (object[i] - frame.origin[i]) * frame.inverse_scale;
  }
  return p;
}

ExactPoint to_tree_exactly(const Frame& frame, const Eigen::Vector3d& object) {
  ExactPoint p;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    p[k] = (Dyadic(object[i]) - Dyadic(frame.origin[i])).times_power_of_two(-exponent_of(frame));
  }
  return p;
}

double error_in_units(const Dyadic& reported, const Quotient& exact_square, double unit) {
  const mpf_class error(abs(reported.to_mpf() - root_of(exact_square)), 320);
  return mpf_class(error / mpf_class(unit, 320), 320).get_d();
}

bool is_at_most(const Dyadic& length, const Quotient& square) {
  if (length.sign() < 0) return true;
  return !(square < Quotient{length * length, 1.0});
}

double root_below(const Quotient& square) {
  return root_of(square).get_d();  // get_d truncates
}

const Decoded* find(const Group& group, std::uint32_t face, std::uint32_t half) {
  for (const Decoded& t : group.triangles) {
    if (t.face == face && t.half == half) return &t;
  }
  return nullptr;
}

}  // namespace boxtree::oracle
