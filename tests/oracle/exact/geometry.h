// SPDX-License-Identifier: MIT
// The exact geometry of the oracle: which closed sets touch, and squared distances. Shares no code
// and no bound with the runtime.
#pragma once

#include <array>
#include <cstddef>

#include "tests/oracle/exact/number.h"

namespace boxtree::oracle {

template <class N>
using Vector = std::array<N, 3>;
template <class N>
using Corners = std::array<Vector<N>, 3>;

using Point = Vector<double>;
using Face = Corners<double>;
using ExactPoint = Vector<Dyadic>;
using ExactFace = Corners<Dyadic>;

/// The same numbers as another type; exact.
template <class N, class M>
[[nodiscard]] Vector<N> as(const Vector<M>& v) {
  return {N(v[0]), N(v[1]), N(v[2])};
}
template <class N, class M>
[[nodiscard]] Corners<N> as(const Corners<M>& t) {
  return {as<N>(t[0]), as<N>(t[1]), as<N>(t[2])};
}

/// Axis-aligned closed box; low <= high.
struct BoxOf {
  Point low;
  Point high;
};

// Whether closed sets share a point. Triangles without area are the segment or point that they are.
// Intervals are tried first for doubles.
[[nodiscard]] bool triangles_touch(const Face& a, const Face& b);
[[nodiscard]] bool triangles_touch(const ExactFace& a, const ExactFace& b);
[[nodiscard]] bool triangle_touches_box(const Face& triangle, const BoxOf& box);
[[nodiscard]] bool segment_touches_triangle(const Point& p, const Point& q, const Face& triangle);

// Squared distances of closed sets.
[[nodiscard]] Quotient squared_distance(const ExactPoint& p, const ExactFace& triangle);
[[nodiscard]] Quotient squared_distance(const ExactFace& a, const ExactFace& b);
[[nodiscard]] Quotient squared_distance(const Face& triangle, const BoxOf& box);

[[nodiscard]] bool has_area(const ExactFace& triangle);

// Bounds, for provably safe rejection.
[[nodiscard]] BoxOf bounds_of(const Face& triangle);
[[nodiscard]] bool boxes_touch(const BoxOf& a, const BoxOf& b);
/// At most the distance of the point from the box.
[[nodiscard]] double distance_below(const Point& p, const BoxOf& box);
/// Largest magnitude of a coordinate.
[[nodiscard]] double largest(const Point& p);
[[nodiscard]] double largest(const Face& t);

/// The unit in the last place of a double of that magnitude; of subnormal ones, the smallest
/// double.
[[nodiscard]] double ulp_of(double magnitude);

// Vectors.
template <class N>
[[nodiscard]] Vector<N> minus(const Vector<N>& a, const Vector<N>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class N>
[[nodiscard]] N dot(const Vector<N>& a, const Vector<N>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class N>
[[nodiscard]] Vector<N> cross(const Vector<N>& a, const Vector<N>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace boxtree::oracle
