// SPDX-License-Identifier: MIT
// The distance of two triangles in extended precision, by an algorithm independent of the code
// under test.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "runtime/primitive/triangle.h"

namespace boxtree::test {

using LongVector = Eigen::Matrix<long double, 3, 1>;
using LongTriangle = std::array<LongVector, 3>;

// A point of the hull of points, and of which of them it is a mean.
struct HullPoint {
  LongVector at;
  std::array<std::size_t, 3> of;
  std::size_t count;
};

// The one closest to the origin. Every vertex, segment and triangle of the points is tried, each by
// a small linear system. A closest point is in one of them unless the origin is inside; then the
// result is some point of them.
inline HullPoint closest_of_all(std::span<const LongVector> d) {
  HullPoint closest{d[0], {0, 0, 0}, 1};
  long double best = d[0].squaredNorm();
  const auto try_point = [&](const LongVector& point, std::array<std::size_t, 3> of,
                             std::size_t count) {
    const long double square = point.squaredNorm();
    if (!(square < best)) return;
    best = square;
    closest = {point, of, count};
  };
  for (std::size_t i = 0; i < d.size(); ++i) {
    try_point(d[i], {i, 0, 0}, 1);
    for (std::size_t j = 0; j < i; ++j) {
      const LongVector e = d[j] - d[i];
      const long double ee = e.squaredNorm();
      if (ee > 0) {
        const long double s = std::clamp(-e.dot(d[i]) / ee, 0.0L, 1.0L);
        try_point(d[i] + s * e, {i, j, 0}, 2);
      }
      for (std::size_t k = 0; k < j; ++k) {
        const LongVector f = d[k] - d[i];
        const LongVector n = e.cross(f);
        const long double nn = n.squaredNorm();
        if (!(nn > 1e-24L * ee * f.squaredNorm())) continue;  // its segments are tried, too
        const long double s = n.dot((-d[i]).cross(f)) / nn;
        const long double t = n.dot(e.cross(-d[i])) / nn;
        if (s < 0 || t < 0 || s + t > 1) continue;
        try_point(d[i] + s * e + t * f, {i, j, k}, 3);
      }
    }
  }
  return closest;
}

// The point of the hull of points that is closest to the origin. Looked for among few of them
// (Gilbert, Johnson and Keerthi, 1988) and taken where it proves itself: all points are beyond the
// plane through it that it is orthogonal to, up to rounding. Else all of them are tried. Ends,
// since each few have a point that is nearer than those before, and there are finitely many.
inline LongVector closest_of_hull(std::span<const LongVector> d) {
  long double size = 0;
  for (const LongVector& p : d) size = std::max(size, p.cwiseAbs().maxCoeff());
  std::array<LongVector, 4> few{d[0]};
  std::size_t count = 1;
  long double best = std::numeric_limits<long double>::infinity();
  for (;;) {
    const HullPoint found = closest_of_all(std::span(few).first(count));
    const long double square = found.at.squaredNorm();
    if (!(square < best)) break;
    best = square;
    const auto nearest =
        std::ranges::min_element(d, {}, [&](const LongVector& p) { return p.dot(found.at); });
    const long double error = 0x1p-59L * size * found.at.cwiseAbs().maxCoeff();
    if (nearest->dot(found.at) >= square - error) return found.at;
    std::array<LongVector, 4> kept;
    for (std::size_t i = 0; i < found.count; ++i) kept[i] = few[found.of[i]];
    kept[found.count] = *nearest;
    few = kept;
    count = found.count + 1;
  }
  return closest_of_all(d).at;
}

/// From the first triangle to the second where they are closest, that is from the origin to the
/// hull of the differences of their corners. Not valid for triangles that cross.
inline LongVector between_in_extended_precision(const LongTriangle& p, const LongTriangle& q) {
  std::array<LongVector, 9> differences;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) differences[3 * i + j] = q[j] - p[i];
  }
  return closest_of_hull(differences);
}

/// How long that is.
inline long double distance_in_extended_precision(const LongTriangle& p, const LongTriangle& q) {
  return between_in_extended_precision(p, q).norm();
}

inline double distance_in_extended_precision(const Triangle& p, const Triangle& q) {
  LongTriangle a, b;
  for (std::size_t i = 0; i < 3; ++i) {
    a[i] = p.corner[i].cast<long double>();
    b[i] = q.corner[i].cast<long double>();
  }
  return static_cast<double>(distance_in_extended_precision(a, b));
}

/// The distance of a point from a triangle.
inline double distance_in_extended_precision(const Eigen::Vector3d& point, const Triangle& t) {
  return distance_in_extended_precision(Triangle{{point, point, point}}, t);
}

}  // namespace boxtree::test
