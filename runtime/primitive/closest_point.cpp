// SPDX-License-Identifier: MIT
// Closest point of a triangle: the projection where it is inside beyond doubt, otherwise the best
// of the edges in question. Nothing is divided by an area that might be rounding noise.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <boxtree/runtime/primitive/closest_point.h>
#include <boxtree/runtime/primitive/vector3.h>

namespace boxtree {
namespace {

// Error bounds. Let u = 2^-53; E1, E2 and W the largest components of e1, e2 and w, E = max(E1,
// E2). A component of a cross product e x f is at most 2 |e| |f| and, after 2 differences, 1
// product and 1 subtraction, off by at most 2 |e| |f| * 4 u. An area below is the sum of three
// products of two such components, n_k <= 2 E1 E2 and m_k <= 2 E W: off by at most 3 * 4 E1 E2 E W
// * 11 u. The third area is n.n minus the other two: off by at most 132 u E1 E2 E (E + 2 W) + 3 u *
// 12 E1 E2 E (E + W). All of it is below 512 u E1 E2 E (E + W).
constexpr double kAreaError = 256 * std::numeric_limits<double>::epsilon();
// n of collinear corners is at most 8 u E1 E2 in each component, n.n below 2^-98 (E1 E2)^2. Weights
// made of that are no candidate: one that happened to be close could win by rounding its distance.
constexpr double kCollinear = 0x1p-96;
// Underflow, for coordinates up to 2^200, takes less than this. A triangle so small that its areas
// are below is answered by its edges.
constexpr double kAreaUnderflow = 0x1p-800;
// Below this squared sine (2 degrees) it pays to look for the corner with the best angle.
constexpr double kThin = 0x1p-10;

double largest(const Eigen::Vector3d& v) {
  return std::max(std::max(std::abs(v[0]), std::abs(v[1])), std::abs(v[2]));
}

double squared_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return squared_length(a - b);
}

// The number of the corner opposite the longest edge. Edges from there are the two shortest, so
// their cross product suffers least from cancellation in a needle.
std::size_t widest_corner(const std::array<Eigen::Vector3d, 3>& c) {
  const double opposite0 = squared_distance(c[1], c[2]);
  const double opposite1 = squared_distance(c[2], c[0]);
  const double opposite2 = squared_distance(c[0], c[1]);
  if (opposite0 >= opposite1 && opposite0 >= opposite2) return 0;
  return opposite1 >= opposite2 ? 1 : 2;
}

// An end is returned as it is, not as a rounded combination.
Eigen::Vector3d closest_on_segment(const Eigen::Vector3d& point, const Eigen::Vector3d& from,
                                   const Eigen::Vector3d& to) {
  const Eigen::Vector3d edge = to - from;
  const double along = dot(point - from, edge);
  const double length_squared = dot(edge, edge);
  if (!(along > 0)) return from;  // also when the ends coincide
  if (along >= length_squared) return to;
  return from + (along / length_squared) * edge;
}

// Where a point projects to in the plane of a triangle.
struct Projection {
  Projection(const Eigen::Vector3d& point, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
             const Eigen::Vector3d& c) noexcept
      : e1(b - a), e2(c - a) {
    const Eigen::Vector3d w = point - a;
    const Eigen::Vector3d n = cross(e1, e2);
    area = dot(n, n);
    area_b = dot(n, cross(w, e2));
    area_c = dot(n, cross(e1, w));
    area_a = area - area_b - area_c;
    const double size1 = largest(e1);
    const double size2 = largest(e2);
    const double size = std::max(size1, size2);
    scale = size1 * size2;
    doubt = kAreaError * scale * size * (size + largest(w)) + kAreaUnderflow;
  }

  [[nodiscard]] bool is_thin() const noexcept { return area < kThin * scale * scale; }
  [[nodiscard]] bool is_collinear() const noexcept {
    return area <= kCollinear * scale * scale + kAreaUnderflow;
  }
  [[nodiscard]] bool is_inside() const noexcept {
    return area_a > doubt && area_b > doubt && area_c > doubt;
  }
  [[nodiscard]] bool is_outside() const noexcept {
    return area_a < -doubt || area_b < -doubt || area_c < -doubt;
  }

  Eigen::Vector3d e1, e2;
  // |n| times the areas of the whole triangle and of its parts opposite a, b and c as seen from the
  // projected point: a part is positive where the point is on the inner side of that edge.
  double area, area_a, area_b, area_c;
  double scale;
  double doubt;  // bound of the error of the parts
};

// The closest of the points tried.
struct Nearest {
  void consider(const Eigen::Vector3d& candidate) noexcept {
    const double candidate_distance = squared_distance(query, candidate);
    if (candidate_distance >= distance) return;
    best = candidate;
    distance = candidate_distance;
  }

  const Eigen::Vector3d& query;
  Eigen::Vector3d best;
  double distance;
};

}  // namespace

Eigen::Vector3d closest_point_on_triangle(const Eigen::Vector3d& point,
                                          const Triangle& triangle) noexcept {
  std::size_t first = 0;
  Projection at(point, triangle.corner[0], triangle.corner[1], triangle.corner[2]);
  if (at.is_thin()) [[unlikely]] {
    first = widest_corner(triangle.corner);
    at = Projection(point, triangle.corner[first], triangle.corner[(first + 1) % 3],
                    triangle.corner[(first + 2) % 3]);
  }
  const Eigen::Vector3d& a = triangle.corner[first];
  const Eigen::Vector3d& b = triangle.corner[(first + 1) % 3];
  const Eigen::Vector3d& c = triangle.corner[(first + 2) % 3];
  if (at.is_inside()) return a + ((at.area_b / at.area) * at.e1 + (at.area_c / at.area) * at.e2);

  // If the point is on the outer side of some edge beyond doubt, the closest point lies on an edge
  // that has it on the outer side; edges that have it on the inner side beyond doubt drop out.
  const bool outside = at.is_outside();
  Nearest nearest{point, a, std::numeric_limits<double>::infinity()};
  if (!outside || at.area_a <= at.doubt) nearest.consider(closest_on_segment(point, b, c));
  if (!outside || at.area_b <= at.doubt) nearest.consider(closest_on_segment(point, c, a));
  if (!outside || at.area_c <= at.doubt) nearest.consider(closest_on_segment(point, a, b));
  // Otherwise it projects to the boundary or, in a sliver, anywhere: doubt about the short edge of
  // a needle does not mean that it is near. Clamped, the projection is a point of the triangle too.
  if (!outside && !at.is_collinear()) {
    const double weight_b = std::clamp(at.area_b / at.area, 0.0, 1.0);
    const double weight_c = std::clamp(at.area_c / at.area, 0.0, 1 - weight_b);
    nearest.consider(a + (weight_b * at.e1 + weight_c * at.e2));
  }
  return nearest.best;
}

}  // namespace boxtree
