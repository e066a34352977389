// SPDX-License-Identifier: MIT
// Touching of closed sets by signs, squared distances as quotients.
#include "tests/oracle/exact/geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace boxtree::oracle {
namespace {

template <class N>
bool is_zero(const Vector<N>& v) {
  return sign_of(v[0]) == 0 && sign_of(v[1]) == 0 && sign_of(v[2]) == 0;
}

// Whether 0 <= x <= whole.
template <class N>
bool is_part(const N& x, const N& whole) {
  return sign_of(x) >= 0 && sign_of(whole - x) >= 0;
}

template <class N>
bool point_touches_segment(const Vector<N>& x, const Vector<N>& p, const Vector<N>& q) {
  const Vector<N> d = minus(q, p), w = minus(x, p);
  if (is_zero(d)) return is_zero(w);
  return is_zero(cross(d, w)) && is_part(dot(d, w), dot(d, d));
}

template <class N>
bool segments_touch(const Vector<N>& p, const Vector<N>& q, const Vector<N>& r,
                    const Vector<N>& s) {
  const Vector<N> d = minus(q, p), e = minus(s, r), w = minus(r, p);
  const Vector<N> n = cross(d, e);
  if (is_zero(n)) {  // parallel, or a point: some end lies on the other one
    return point_touches_segment(p, r, s) || point_touches_segment(q, r, s) ||
           point_touches_segment(r, p, q) || point_touches_segment(s, p, q);
  }
  if (sign_of(dot(w, n)) != 0) return false;
  // p + a d = r + b e with a = (w x e) . n / n . n, b = (w x d) . n / n . n.
  const N whole = dot(n, n);
  return is_part(dot(cross(w, e), n), whole) && is_part(dot(cross(w, d), n), whole);
}

template <class N>
bool has_mixed_signs(int a, int b, int c) {
  return (a < 0 || b < 0 || c < 0) && (a > 0 || b > 0 || c > 0);
}

// Precondition: x lies in the plane of t, whose normal n is not zero.
template <class N>
bool point_in_plane_touches(const Vector<N>& x, const Corners<N>& t, const Vector<N>& n) {
  std::array<int, 3> side{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector<N>& from = t[i];
    side[i] = sign_of(dot(cross(minus(t[(i + 1) % 3], from), minus(x, from)), n));
  }
  return !has_mixed_signs<N>(side[0], side[1], side[2]);
}

template <class N>
bool segment_touches_edges(const Vector<N>& p, const Vector<N>& q, const Corners<N>& t) {
  return segments_touch(p, q, t[0], t[1]) || segments_touch(p, q, t[1], t[2]) ||
         segments_touch(p, q, t[2], t[0]);
}

template <class N>
int orientation(const Vector<N>& p, const Vector<N>& q, const Vector<N>& a, const Vector<N>& b) {
  return sign_of(dot(minus(q, p), cross(minus(a, p), minus(b, p))));
}

template <class N>
bool segment_touches(const Vector<N>& p, const Vector<N>& q, const Corners<N>& t,
                     const Vector<N>& n) {
  if (is_zero(n)) return segment_touches_edges(p, q, t);
  const int from = sign_of(dot(n, minus(p, t[0])));
  const int to = sign_of(dot(n, minus(q, t[0])));
  if (from * to > 0) return false;
  if (from == 0 && to == 0) {
    return point_in_plane_touches(p, t, n) || segment_touches_edges(p, q, t);
  }
  // The line crosses the plane in one point of the segment; is that in the triangle?
  return !has_mixed_signs<N>(orientation(p, q, t[0], t[1]), orientation(p, q, t[1], t[2]),
                             orientation(p, q, t[2], t[0]));
}

template <class N>
Vector<N> normal_of(const Corners<N>& t) {
  return cross(minus(t[1], t[0]), minus(t[2], t[0]));
}

// Whether all of b lies strictly on one side of a's plane.
template <class N>
bool is_beside_plane(const Corners<N>& a, const Vector<N>& n, const Corners<N>& b) {
  const int first = sign_of(dot(n, minus(b[0], a[0])));
  return first != 0 && first == sign_of(dot(n, minus(b[1], a[0]))) &&
         first == sign_of(dot(n, minus(b[2], a[0])));
}

// Two triangles that share a point do so at an edge of one of them: what they share is a point, a
// segment or a polygon, and the ends or corners of that lie on edges.
template <class N>
bool touch(const Corners<N>& a, const Corners<N>& b) {
  const Vector<N> n = normal_of(a), m = normal_of(b);
  if (is_beside_plane(a, n, b) || is_beside_plane(b, m, a)) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    if (segment_touches(a[i], a[(i + 1) % 3], b, m)) return true;
    if (segment_touches(b[i], b[(i + 1) % 3], a, n)) return true;
  }
  return false;
}

// Whether triangle and box lie strictly on different sides along a direction.
template <class N>
bool separates(const Vector<N>& axis, const Corners<N>& t, const BoxOf& box) {
  N low(0.0), high(0.0);  // the box along the axis
  for (std::size_t k = 0; k < 3; ++k) {
    const bool up = sign_of(axis[k]) > 0;
    low = low + axis[k] * N(up ? box.low[k] : box.high[k]);
    high = high + axis[k] * N(up ? box.high[k] : box.low[k]);
  }
  int above = 0, below = 0;
  for (const Vector<N>& corner : t) {
    const N at = dot(axis, corner);
    above += sign_of(at - high) > 0 ? 1 : 0;
    below += sign_of(low - at) > 0 ? 1 : 0;
  }
  return above == 3 || below == 3;
}

// Separating axes. Complete also for flat boxes and triangles without area: see geometry_test.cpp,
// which compares with another way to decide it.
template <class N>
bool touch(const Corners<N>& t, const BoxOf& box) {
  if (separates(normal_of(t), t, box)) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector<N> edge = minus(t[(i + 1) % 3], t[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      Vector<N> axis{N(0.0), N(0.0), N(0.0)};
      axis[(k + 1) % 3] = N(0.0) - edge[(k + 2) % 3];
      axis[(k + 2) % 3] = edge[(k + 1) % 3];
      if (separates(axis, t, box)) return false;
    }
  }
  return true;
}

// By intervals, and exactly where those do not tell.
template <class Body>
bool filtered(Body body) {
  try {
    return body(Interval());
  } catch (const Uncertain&) {
    return body(Dyadic());
  }
}

using D = Dyadic;

Quotient squared_to_segment(const ExactPoint& x, const ExactPoint& p, const ExactPoint& q) {
  const ExactPoint d = minus(q, p), w = minus(x, p), v = minus(x, q);
  const D along = dot(d, w), whole = dot(d, d);
  if (along.sign() <= 0) return {dot(w, w), 1.0};
  if ((whole - along).sign() <= 0) return {dot(v, v), 1.0};
  const ExactPoint c = cross(d, w);
  return {dot(c, c), whole};
}

// Of two segments whose nearest points are both inner ones; other cases are those of an end.
std::optional<Quotient> squared_of_inner_points(const ExactPoint& p, const ExactPoint& q,
                                                const ExactPoint& r, const ExactPoint& s) {
  const ExactPoint d = minus(q, p), e = minus(s, r), w = minus(r, p), n = cross(d, e);
  const D whole = dot(n, n);
  if (whole.sign() == 0) return std::nullopt;
  if (!is_part(dot(cross(w, e), n), whole) || !is_part(dot(cross(w, d), n), whole)) {
    return std::nullopt;
  }
  const D height = dot(w, n);
  return Quotient{height * height, whole};
}

}  // namespace

bool triangles_touch(const ExactFace& a, const ExactFace& b) {
  return touch(a, b);
}

bool triangles_touch(const Face& a, const Face& b) {
  if (!boxes_touch(bounds_of(a), bounds_of(b))) return false;
  return filtered([&](auto tag) {
    using N = decltype(tag);
    return touch(as<N>(a), as<N>(b));
  });
}

bool triangle_touches_box(const Face& triangle, const BoxOf& box) {
  if (!boxes_touch(bounds_of(triangle), box)) return false;
  return filtered([&](auto tag) { return touch(as<decltype(tag)>(triangle), box); });
}

bool segment_touches_triangle(const Point& p, const Point& q, const Face& triangle) {
  return filtered([&](auto tag) {
    using N = decltype(tag);
    const Corners<N> t = as<N>(triangle);
    return segment_touches(as<N>(p), as<N>(q), t, normal_of(t));
  });
}

Quotient squared_distance(const ExactPoint& p, const ExactFace& t) {
  const ExactPoint n = normal_of(t);
  if (!is_zero(n) && point_in_plane_touches(p, t, n)) {
    // The signs along n do not depend on the height of p above the plane.
    const D height = dot(n, minus(p, t[0]));
    return {height * height, dot(n, n)};
  }
  return std::min({squared_to_segment(p, t[0], t[1]), squared_to_segment(p, t[1], t[2]),
                   squared_to_segment(p, t[2], t[0])});
}

Quotient squared_distance(const ExactFace& a, const ExactFace& b) {
  if (touch(a, b)) return {};
  Quotient best = squared_distance(a[0], b);
  for (std::size_t i = 0; i < 3; ++i) {
    best = std::min({best, squared_distance(a[i], b), squared_distance(b[i], a)});
    for (std::size_t j = 0; j < 3; ++j) {
      const auto inner = squared_of_inner_points(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]);
      if (inner && *inner < best) best = *inner;
    }
  }
  return best;
}

Quotient squared_distance(const Face& triangle, const BoxOf& box) {
  if (triangle_touches_box(triangle, box)) return {};
  const ExactFace t = as<D>(triangle);
  std::optional<Quotient> best;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t u = (k + 1) % 3, v = (k + 2) % 3;
    for (const Point& at : {box.low, box.high}) {
      std::array<Point, 4> side{at, at, at, at};
      side[1][u] = side[2][u] = at[u] == box.low[u] ? box.high[u] : box.low[u];
      side[2][v] = side[3][v] = at[v] == box.low[v] ? box.high[v] : box.low[v];
      for (const Face& half : {Face{side[0], side[1], side[2]}, Face{side[0], side[2], side[3]}}) {
        const Quotient found = squared_distance(t, as<D>(half));
        if (!best || found < *best) best = found;
      }
    }
  }
  return *best;
}

bool has_area(const ExactFace& triangle) {
  return !is_zero(normal_of(triangle));
}

BoxOf bounds_of(const Face& t) {
  BoxOf box;
  for (std::size_t k = 0; k < 3; ++k) {
    box.low[k] = std::min({t[0][k], t[1][k], t[2][k]});
    box.high[k] = std::max({t[0][k], t[1][k], t[2][k]});
  }
  return box;
}

bool boxes_touch(const BoxOf& a, const BoxOf& b) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (a.low[k] > b.high[k] || b.low[k] > a.high[k]) return false;
  }
  return true;
}

double distance_below(const Point& p, const BoxOf& box) {
  double largest_gap = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    largest_gap = std::max({largest_gap, box.low[k] - p[k], p[k] - box.high[k]});
  }
  return largest_gap * (1 - 4 * std::numeric_limits<double>::epsilon());
}

double largest(const Point& p) {
  return std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
}
double largest(const Face& t) {
  return std::max({largest(t[0]), largest(t[1]), largest(t[2])});
}

double ulp_of(double magnitude) {
  if (magnitude < std::numeric_limits<double>::min()) {
    return std::numeric_limits<double>::denorm_min();
  }
  return std::max(std::ldexp(1.0, std::ilogb(magnitude) - 52),
                  std::numeric_limits<double>::denorm_min());
}

}  // namespace boxtree::oracle
