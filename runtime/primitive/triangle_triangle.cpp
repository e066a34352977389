// SPDX-License-Identifier: MIT
// Overlap of two triangles by orientation signs (after Guigue and Devillers, "Fast and Robust
// Triangle-Triangle Overlap Test Using Orientation Predicates", 2003). No point is constructed, so
// nothing but the signs can be wrong, and they are exact.
#include "runtime/primitive/triangle_triangle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "runtime/primitive/orientation.h"

namespace boxtree {
namespace {

using Signs = std::array<int, 3>;

// The plane through a triangle's corners, prepared for the signs of many points. The normal and its
// magnitudes are the terms of orient3d with the origin at corner 0 instead of at the query point:
// as many roundings, so the same error bound.
class Plane {
 public:
  explicit Plane(const Triangle& triangle) noexcept : triangle_(triangle) {
    const Eigen::Vector3d e = triangle.corner[1] - triangle.corner[0];
    const Eigen::Vector3d f = triangle.corner[2] - triangle.corner[0];
    const Eigen::Vector3d plus(e[1] * f[2], e[2] * f[0], e[0] * f[1]);
    const Eigen::Vector3d minus(e[2] * f[1], e[0] * f[2], e[1] * f[0]);
    normal_ = plus - minus;
    magnitude_ = plus.cwiseAbs() + minus.cwiseAbs();
  }

  // +1 above, where the corners are seen counter-clockwise; 0 for any point if they are collinear.
  [[nodiscard]] int side(const Eigen::Vector3d& point) const noexcept {
    const std::array<Eigen::Vector3d, 3>& corner = triangle_.corner;
    const double x = point[0] - corner[0][0];
    const double y = point[1] - corner[0][1];
    const double z = point[2] - corner[0][2];
    const double height = (normal_[0] * x + normal_[1] * y) + normal_[2] * z;
    const double magnitude =
        (magnitude_[0] * std::abs(x) + magnitude_[1] * std::abs(y)) + magnitude_[2] * std::abs(z);
    const double bound = kOrient3dBound * magnitude + kOrientUnderflow;
    if (height > bound) return 1;
    if (height < -bound) return -1;
    return -orient3d_exact(corner[0], corner[1], corner[2], point);
  }

  [[nodiscard]] Signs sides(const Triangle& other) const noexcept {
    return {side(other.corner[0]), side(other.corner[1]), side(other.corner[2])};
  }

 private:
  const Triangle& triangle_;
  Eigen::Vector3d normal_;
  Eigen::Vector3d magnitude_;
};

bool is_strictly_one_sided(const Signs& s) {
  return s[0] != 0 && s[0] == s[1] && s[0] == s[2];
}

bool is_zero(const Signs& s) {
  return s[0] == 0 && s[1] == 0 && s[2] == 0;
}

// How a triangle crosses a plane: `apex` lies on one closed side, the other two corners on the
// opposite closed side, and neither edge at the apex lies in the plane. So each of these two edges
// meets the plane in one point, and the triangle meets it in the segment between the two.
struct Crossing {
  std::uint8_t apex;
  bool apex_below;
};

constexpr std::size_t crossing_index(int s0, int s1, int s2) {
  const auto digit = [](int sign) { return static_cast<std::size_t>(sign) + 1; };
  return digit(s0) * 9 + digit(s1) * 3 + digit(s2);
}

constexpr Crossing find_crossing(const Signs& s) {
  for (std::uint8_t i = 0; i < 3; ++i) {  // an apex off the plane, the others not on its side
    const int apex = s[i], next = s[(i + 1u) % 3], last = s[(i + 2u) % 3];
    if (apex != 0 && next != apex && last != apex) return {i, apex < 0};
  }
  for (std::uint8_t i = 0; i < 3; ++i) {  // an apex in the plane, the others both to one side
    if (s[i] == 0 && s[(i + 1u) % 3] != 0) return {i, s[(i + 1u) % 3] > 0};
  }
  return {0, false};  // strictly one-sided or all zero: never needed
}

constexpr std::array<Crossing, 27> kCrossings = [] {
  std::array<Crossing, 27> table{};
  for (int s0 = -1; s0 <= 1; ++s0) {
    for (int s1 = -1; s1 <= 1; ++s1) {
      for (int s2 = -1; s2 <= 1; ++s2)
        table[crossing_index(s0, s1, s2)] = find_crossing({s0, s1, s2});
    }
  }
  return table;
}();

// Two triangles that cross each other's planes, neither degenerate nor coplanar. Each intersects
// the line common to the planes in an interval; the triangles overlap if the intervals do.
//
// With each apex above the other plane (swapping two corners turns a plane over), direct the line
// along normal(q) x normal(p). Then p's interval runs from its edge 0-1 to its edge 0-2 and q's
// from its edge 0-2 to its edge 0-1. Write x and y for the points where edge 0-1 of p and edge 0-1
// of q intersect the line: the volume of the tetrahedron p0 p1 q0 q1 is a positive multiple of
// det(p0 - p1, y - x, q0 - q1), whose sign gives the order of x and y on the line. The same with
// edges 0-2 gives the order of the other two ends.
bool crossing_intervals_overlap(const Triangle& p, const Triangle& q, const Signs& p_sides,
                                const Signs& q_sides) {
  const Crossing pc = kCrossings[crossing_index(p_sides[0], p_sides[1], p_sides[2])];
  const Crossing qc = kCrossings[crossing_index(q_sides[0], q_sides[1], q_sides[2])];
  const std::size_t p_first = qc.apex_below ? 2 : 1, q_first = pc.apex_below ? 2 : 1;
  const Eigen::Vector3d& p0 = p.corner[pc.apex];
  const Eigen::Vector3d& p1 = p.corner[(pc.apex + p_first) % 3];
  const Eigen::Vector3d& p2 = p.corner[(pc.apex + 3 - p_first) % 3];
  const Eigen::Vector3d& q0 = q.corner[qc.apex];
  const Eigen::Vector3d& q1 = q.corner[(qc.apex + q_first) % 3];
  const Eigen::Vector3d& q2 = q.corner[(qc.apex + 3 - q_first) % 3];
  return orient3d(p0, p1, q0, q1) >= 0 && orient3d(p0, p2, q0, q2) <= 0;
}

// ---- In a plane ----

Eigen::Vector2d drop(const Eigen::Vector3d& v, Eigen::Index axis) {
  return {v[(axis + 1) % 3], v[(axis + 2) % 3]};
}

// A closed segment (2 corners, possibly equal, winding 0) or proper triangle (3 corners, winding
// +1 or -1) of the plane.
struct FlatShape {
  std::array<Eigen::Vector2d, 3> corner;
  std::size_t size;
  int winding;
};

// Whether all of `b` lies strictly beyond the line through one edge of `a`.
bool edge_separates(const FlatShape& a, const FlatShape& b) {
  const std::size_t edges = a.size == 2 ? 1 : 3;
  for (std::size_t i = 0; i < edges; ++i) {
    const Eigen::Vector2d& from = a.corner[i];
    const Eigen::Vector2d& to = a.corner[(i + 1) % a.size];
    const int sign = orient2d(from, to, b.corner[0]);
    if (sign == 0 || sign == a.winding) continue;
    bool beyond = true;
    for (std::size_t k = 1; beyond && k < b.size; ++k) {
      beyond = orient2d(from, to, b.corner[k]) == sign;
    }
    if (beyond) return true;
  }
  return false;
}

bool bounds_overlap(const FlatShape& a, const FlatShape& b) {
  for (Eigen::Index k = 0; k < 2; ++k) {
    double a_low = a.corner[0][k], a_high = a_low, b_low = b.corner[0][k], b_high = b_low;
    for (std::size_t i = 1; i < a.size; ++i) {
      a_low = std::min(a_low, a.corner[i][k]);
      a_high = std::max(a_high, a.corner[i][k]);
    }
    for (std::size_t i = 1; i < b.size; ++i) {
      b_low = std::min(b_low, b.corner[i][k]);
      b_high = std::max(b_high, b.corner[i][k]);
    }
    if (a_low > b_high || b_low > a_high) return false;
  }
  return true;
}

// The Minkowski difference of the shapes has edges parallel to theirs, so if they are disjoint an
// edge of one separates them. Collinear segments are the exception; their bounds decide.
bool flat_shapes_overlap(const FlatShape& a, const FlatShape& b) {
  return bounds_overlap(a, b) && !edge_separates(a, b) && !edge_separates(b, a);
}

// ---- Coplanar and degenerate triangles ----

struct Segment {
  Eigen::Vector3d from;
  Eigen::Vector3d to;
};

FlatShape flatten(const Segment& s, Eigen::Index axis) {
  return {{drop(s.from, axis), drop(s.to, axis), {}}, 2, 0};
}

// A triangle and the axis along which its projection keeps an area; a degenerate one has none.
struct Projection {
  FlatShape shape;
  Eigen::Index axis;

  [[nodiscard]] bool is_degenerate() const noexcept { return shape.winding == 0; }
};

Projection project(const Triangle& t) {
  for (Eigen::Index axis = 2; axis >= 0; --axis) {
    const FlatShape flat{
        {drop(t.corner[0], axis), drop(t.corner[1], axis), drop(t.corner[2], axis)}, 3, 0};
    const int winding = orient2d(flat.corner[0], flat.corner[1], flat.corner[2]);
    if (winding != 0) return {{flat.corner, 3, winding}, axis};
  }
  return {{{}, 3, 0}, 0};
}

bool comes_first(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

// What is left of a degenerate triangle: its corners lie on a line, along which lexicographic order
// is monotone, so the first and the last corner are the ends.
Segment remaining_segment(const Triangle& t) {
  const auto ends = std::minmax_element(t.corner.begin(), t.corner.end(), comes_first);
  return {*ends.first, *ends.second};
}

[[gnu::cold]] bool segment_intersects_triangle(const Segment& s, const Triangle& t,
                                               const Projection& projection) {
  const std::array<Eigen::Vector3d, 3>& c = t.corner;
  const int from_side = orient3d(c[0], c[1], c[2], s.from);
  const int to_side = orient3d(c[0], c[1], c[2], s.to);
  if (from_side == 0 && to_side == 0) {
    return flat_shapes_overlap(flatten(s, projection.axis), projection.shape);
  }
  if (from_side == to_side) return false;
  // The line meets the plane in one point, inside if it passes all edges on the same side.
  bool left = false;
  bool right = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const int sign = orient3d(s.from, s.to, c[i], c[(i + 1) % 3]);
    left |= sign > 0;
    right |= sign < 0;
  }
  return !(left && right);
}

// Coplanar segments intersect if their projections do along an axis that is not in their plane.
// Testing along all three is equivalent and needs no choice.
[[gnu::cold]] bool segments_intersect(const Segment& s, const Segment& t) {
  if (orient3d(s.from, s.to, t.from, t.to) != 0) return false;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (!flat_shapes_overlap(flatten(s, axis), flatten(t, axis))) return false;
  }
  return true;
}

// Coplanar triangles, or at least one degenerate.
bool flat_triangles_intersect(const Triangle& p, const Triangle& q) {
  const Projection p_flat = project(p);
  const Projection q_flat = project(q);
  if (p_flat.is_degenerate() && q_flat.is_degenerate()) {
    return segments_intersect(remaining_segment(p), remaining_segment(q));
  }
  if (p_flat.is_degenerate()) return segment_intersects_triangle(remaining_segment(p), q, q_flat);
  if (q_flat.is_degenerate()) return segment_intersects_triangle(remaining_segment(q), p, p_flat);
  // Parallel planes lose their area along the same axes, so both chose the same one.
  return flat_shapes_overlap(p_flat.shape, q_flat.shape);
}

}  // namespace

bool triangles_intersect(const Triangle& p, const Triangle& q) noexcept {
  const Signs q_sides = Plane(p).sides(q);
  if (is_strictly_one_sided(q_sides)) return false;
  // A degenerate triangle's plane gives zeros only, and so does the plane of a coplanar one.
  if (is_zero(q_sides)) return flat_triangles_intersect(p, q);
  const Signs p_sides = Plane(q).sides(p);
  if (is_strictly_one_sided(p_sides)) return false;
  if (is_zero(p_sides)) return flat_triangles_intersect(p, q);  // q is degenerate
  return crossing_intervals_overlap(p, q, p_sides, q_sides);
}

}  // namespace boxtree
