// SPDX-License-Identifier: MIT
// Closest points of two triangles by their features: two edges, or a corner and a face. Two points
// are closest if the planes through them, orthogonal to the line between them, have the triangles
// on either side (Larsen, Gottschalk, Lin, Manocha, "Fast Proximity Queries with Swept Sphere
// Volumes", 1999): that ends the search early. No bound relies on it: the lower one is computed
// separately, from directions that the search suggests.
#include "runtime/primitive/triangle_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "runtime/primitive/closest_point.h"
#include "runtime/primitive/rounding.h"
#include "runtime/primitive/separation.h"
#include "runtime/primitive/vector3.h"

namespace boxtree {
namespace {

// By how much two computed points can be closer to each other than their triangles. Let u = 2^-53,
// R the largest coordinate. A point a + s e of an edge, s exact by definition, is off by at most 5
// R u per component: 2 of the edge, 2 of the product, 1 of the sum. A point of a face is off by 7 R
// u, and by 8 R u more where its weights exceed 1 by 4 u. At worst an edge pierces a face: 20 R u
// per component, below 36 R u in length.
constexpr double kPointError = 36 * kRoundoffF64;
// Difference of the points, squares, sum and root: below a factor 1 + 4 u.
constexpr double kUpperQuotient = 1 + 4 * kRoundoffF64;
// The line between two computed points is off by at most 10 R u per component, and a vector to a
// corner of the triangle is at most 2 R long on each axis: 60 R R u. The rest covers the rounding
// of their product.
constexpr double kPlaneError = 80 * kRoundoffF64;
// Squares of numbers below 2^-537 underflow.
constexpr double kUpperUnderflow = 0x1p-500;

using Corners = std::array<Eigen::Vector3d, 3>;

// A point of a segment; an end is returned as it is.
Eigen::Vector3d along(const Eigen::Vector3d& from, const Eigen::Vector3d& edge,
                      const Eigen::Vector3d& to, double s) {
  if (s <= 0) return from;
  if (s >= 1) return to;
  return from + s * edge;
}

double unit_quotient(double numerator, double denominator) {
  return denominator > 0 ? std::clamp(numerator / denominator, 0.0, 1.0) : 0.0;
}

struct Search {
  // `is_segment`: p has one edge, which is all of it.
  Search(const Corners& p_corners, const Corners& q_corners, bool is_segment_) noexcept
      : p(p_corners),
        q(q_corners),
        is_segment(is_segment_),
        p_edge(edges_of(p)),
        q_edge(edges_of(q)) {
    max_abs = std::max(max_abs_of(p), max_abs_of(q));
    doubt = kPlaneError * max_abs * max_abs;
  }

  // Returns whether the pair is the closest so far.
  bool consider(const Eigen::Vector3d& on_p, const Eigen::Vector3d& on_q) noexcept {
    const Eigen::Vector3d v = on_q - on_p;
    const double candidate = dot(v, v);
    if (!(candidate < squared)) return false;
    squared = candidate;
    first = on_p;
    second = on_q;
    between = v;
    return true;
  }

  // Closest points of edge i of p and edge j of q. Returns whether the planes through them prove
  // that they are the closest of the triangles.
  //
  // The parameter of the common perpendicular comes from cross products, not from the usual a c - b
  // b: its error is then u / sin(angle) and not u / sin^2. It moves the point in a direction in
  // which the distance changes with the sine only, so the distance is off by rounding alone.
  [[gnu::noinline]] bool try_edges(std::size_t i, std::size_t j) noexcept {
    const Eigen::Vector3d& a = p[i];
    const Eigen::Vector3d& b = q[j];
    const Eigen::Vector3d& e = p_edge[i];
    const Eigen::Vector3d& f = q_edge[j];
    const Eigen::Vector3d w = b - a;
    const Eigen::Vector3d n = cross(e, f);
    double s = unit_quotient(dot(cross(w, f), n), dot(n, n));
    Eigen::Vector3d on_p = along(a, e, p[(i + 1) % 3], s);
    const double ff = dot(f, f);
    const double t_raw = dot(f, on_p - b);
    double t = unit_quotient(t_raw, ff);
    if (t_raw < 0 || t_raw >= ff) {  // also when the edge of q is a point
      s = unit_quotient(dot(e, (t <= 0 ? b : q[(j + 1) % 3]) - a), dot(e, e));
      on_p = along(a, e, p[(i + 1) % 3], s);
    }
    const Eigen::Vector3d on_q = along(b, f, q[(j + 1) % 3], t);
    if (!consider(on_p, on_q)) return false;
    return (is_segment || dot(p[(i + 2) % 3] - on_p, between) <= -doubt) &&
           dot(q[(j + 2) % 3] - on_q, between) >= doubt;
  }

  // `p_edges`: 1 if p is a segment.
  bool try_all_edges(std::size_t p_edges) noexcept {
    for (std::size_t i = 0; i < p_edges; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        if (try_edges(i, j)) return true;
      }
    }
    return false;
  }

  // The corner nearest to the face, if all are on one side of it. If its foot lies beyond the
  // face's edges, the closest point is on an edge and has been found.
  [[gnu::noinline]] void try_face(const Corners& face, const Corners& face_edge,
                                  const Corners& corner, bool face_is_p) noexcept {
    const Eigen::Vector3d n = cross(face_edge[0], face_edge[1]);
    std::size_t lowest = 0;
    std::array<double, 3> height;
    for (std::size_t k = 0; k < 3; ++k) {
      height[k] = dot(n, corner[k] - face[0]);
      if (std::abs(height[k]) < std::abs(height[lowest])) lowest = k;
    }
    const bool above = height[0] > 0 && height[1] > 0 && height[2] > 0;
    const bool below = height[0] < 0 && height[1] < 0 && height[2] < 0;
    if (!above && !below) return;
    const Eigen::Vector3d foot = closest_point_on_triangle(corner[lowest], {face});
    if (face_is_p) {
      consider(foot, corner[lowest]);
    } else {
      consider(corner[lowest], foot);
    }
  }

  // For triangles that touch or nearly do: corners on the other triangle, edges through it. Returns
  // whether any of them is closer than what was found before.
  bool try_contacts() noexcept {
    const double before = squared;
    for (const Eigen::Vector3d& c : q) consider(closest_point_on_triangle(c, {p}), c);
    for (const Eigen::Vector3d& c : p) consider(c, closest_point_on_triangle(c, {q}));
    const auto pierce = [&](const Corners& face, const Corners& face_edge, const Corners& corner,
                            bool face_is_p) {
      const Eigen::Vector3d n = cross(face_edge[0], face_edge[1]);
      for (std::size_t k = 0; k < 3; ++k) {
        const Eigen::Vector3d& from = corner[k];
        const Eigen::Vector3d& to = corner[(k + 1) % 3];
        const double from_height = dot(n, from - face[0]);
        const double to_height = dot(n, to - face[0]);
        if (!((from_height < 0) != (to_height < 0))) continue;
        const double s = std::clamp(from_height / (from_height - to_height), 0.0, 1.0);
        const Eigen::Vector3d at = along(from, to - from, to, s);
        const Eigen::Vector3d foot = closest_point_on_triangle(at, {face});
        if (face_is_p) {
          consider(foot, at);
        } else {
          consider(at, foot);
        }
      }
    };
    pierce(p, p_edge, q, true);
    pierce(q, q_edge, p, false);
    return squared < before;
  }

  [[nodiscard]] double upper() const noexcept {
    return std::sqrt(squared) * kUpperQuotient + (kPointError * max_abs + kUpperUnderflow);
  }

  const Corners& p;
  const Corners& q;
  bool is_segment;
  Corners p_edge;
  Corners q_edge;
  double max_abs;
  double doubt;
  double squared = std::numeric_limits<double>::infinity();
  Eigen::Vector3d first;
  Eigen::Vector3d second;
  Eigen::Vector3d between;  // second - first
};

// What the search has found, with a lower bound.
TriangleDistance distance_found(Search& search) noexcept {
  // Bounds this close differ by rounding alone.
  const auto enough = [&] { return search.upper() - 2 * kPointError * search.max_abs; };
  const auto separation = [&] {
    return separation_near(search.first, search.second, search.p, search.q, search.max_abs,
                           enough());
  };
  Separation best = separation();
  if (!(best.lower >= enough()) && search.try_contacts()) {
    if (const Separation nearer = separation(); nearer.lower > best.lower) best = nearer;
  }
  return {best.lower, search.upper(), search.first, search.second, best.direction};
}

TriangleDistance points_found(const Search& search) noexcept {
  return {0, search.upper(), search.first, search.second, Eigen::Vector3d::Zero()};
}

[[gnu::noinline]] void search_from_segment(Search& search) noexcept {
  if (!search.try_all_edges(1)) search.try_face(search.q, search.q_edge, search.p, false);
}

}  // namespace

TriangleDistance triangle_distance(const Triangle& p, const Triangle& q) noexcept {
  Search search(p.corner, q.corner, false);
  if (!search.try_all_edges(3)) {
    search.try_face(p.corner, search.p_edge, q.corner, true);
    search.try_face(q.corner, search.q_edge, p.corner, false);
  }
  return distance_found(search);
}

TriangleDistance segment_distance(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                  const Triangle& q) noexcept {
  const Corners segment{from, to, to};
  Search search(segment, q.corner, true);
  search_from_segment(search);
  return distance_found(search);
}

TriangleDistance segment_closest_points(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                        const Triangle& q) noexcept {
  const Corners segment{from, to, to};
  Search search(segment, q.corner, true);
  search_from_segment(search);
  return points_found(search);
}

TriangleDistance closest_points_of_part(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                        const Triangle& q, std::size_t part) noexcept {
  const Corners segment{from, to, to};
  Search search(segment, q.corner, true);
  if (part < 2) {
    search.consider(segment[part], closest_point_on_triangle(segment[part], q));
  } else {
    search.try_edges(0, part - 2);
  }
  return points_found(search);
}

}  // namespace boxtree
