// SPDX-License-Identifier: MIT
// What is exactly true of a ray and a triangle, and how far an answer may be from it.
#pragma once

#include "tests/oracle/exact/geometry.h"

namespace boxtree::oracle {

/// A line; t counts in units of the direction. Precondition: the direction is not zero.
struct ExactRay {
  ExactRay(const Point& from, const Point& along);

  Point origin;
  Point direction;
  std::array<std::size_t, 3> axis;  // the last is that of the largest component
};

/// The triangle as seen along the ray: sheared so that the ray is x = y = 0.
struct RayTruth {
  bool is_surely_hit;    // inside by more than the tolerance
  bool may_be_hit;       // inside, or outside by less
  double t;              // NaN where it is edge-on
  double t_low, t_high;  // of the corners
  double t_tolerance;
};

/// `tolerance`: of sheared coordinates, relative to the farthest corner as seen from the origin;
/// `more`: of the same, absolute. What it does to t is derived from the triangle's height and span
/// along the ray.
[[nodiscard]] RayTruth truth_of(const ExactRay& ray, const Face& triangle, double tolerance,
                                double more, int exponent);

}  // namespace boxtree::oracle
