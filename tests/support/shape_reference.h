// SPDX-License-Identifier: MIT
// Convex shapes and surfaces in extended precision, by algorithms independent of the code under
// test.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <boxtree/shape.h>

#include "runtime/tree/bound_tree.h"
#include "tests/support/cooked.h"
#include "tests/support/triangle_reference.h"

namespace boxtree::test {

// A shape as triangles: a point, a segment, the sides of a box, or the points of a hull; and a
// radius around them.
struct LongShape {
  std::vector<LongTriangle> core;
  long double radius = 0;
  LongVector center;
  long double reach = 0;  // of the core from its center
  bool is_solid = false;
  bool is_hull = false;
  std::array<LongVector, 3> axis{LongVector::Zero(), LongVector::Zero(), LongVector::Zero()};
  std::array<long double, 3> half{};
};

inline LongShape long_shape(const Sphere& sphere) {
  const LongVector c = sphere.center.cast<long double>();
  return {{{c, c, c}}, sphere.radius, c, 0, false, false, {}, {}};
}

inline LongShape long_shape(const Capsule& capsule) {
  const LongVector a = capsule.start.cast<long double>(), b = capsule.end.cast<long double>();
  return {{{a, b, b}}, capsule.radius, (a + b) / 2, (b - a).norm() / 2, false, false, {}, {}};
}

inline LongShape long_box(const LongVector& center, const std::array<LongVector, 3>& axis,
                          const std::array<long double, 3>& half) {
  LongShape shape;
  shape.center = center;
  shape.axis = axis;
  shape.half = half;
  const auto corner = [&](int signs) {
    LongVector p = shape.center;
    for (std::size_t k = 0; k < 3; ++k) {
      p += ((signs >> k) & 1 ? 1 : -1) * shape.half[k] * shape.axis[k];
    }
    return p;
  };
  for (int k = 0; k < 3; ++k) {
    const int u = 1 << ((k + 1) % 3), v = 1 << ((k + 2) % 3);
    for (const int side : {0, 1 << k}) {
      shape.core.push_back({corner(side), corner(side | u), corner(side | u | v)});
      shape.core.push_back({corner(side), corner(side | u | v), corner(side | v)});
    }
  }
  shape.reach = (corner(7) - shape.center).norm();
  shape.is_solid = true;
  return shape;
}

inline LongShape long_shape(const OrientedBox& box) {
  const auto& q = box.rotation;
  const Eigen::Quaternion<long double> turn =
      Eigen::Quaternion<long double>(q.w(), q.x(), q.y(), q.z()).normalized();
  std::array<LongVector, 3> axis;
  std::array<long double, 3> half{};
  for (int k = 0; k < 3; ++k) {
    axis[static_cast<std::size_t>(k)] = turn * LongVector::Unit(k);
    half[static_cast<std::size_t>(k)] = box.half_extents[k];
  }
  return long_box(box.center.cast<long double>(), axis, half);
}

inline LongShape long_hull(std::span<const LongVector> points) {
  LongShape shape;
  LongVector low = points[0], high = points[0];
  for (const LongVector& p : points) {
    shape.core.push_back({p, p, p});
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  shape.center = (low + high) / 2;
  for (const LongVector& p : points) shape.reach = std::max(shape.reach, (p - shape.center).norm());
  shape.is_hull = true;
  return shape;
}

inline LongShape long_shape(const ConvexHull& hull) {
  const auto& q = hull.rotation;
  const Eigen::Quaternion<long double> turn =
      Eigen::Quaternion<long double>(q.w(), q.x(), q.y(), q.z()).normalized();
  std::vector<LongVector> points;
  for (const Eigen::Vector3d& p : hull.points) {
    points.push_back(hull.position.cast<long double>() + turn * p.cast<long double>());
  }
  return long_hull(points);
}

// Whether points are off the plane through those of them that are farthest from each other, by more
// than rounding.
inline bool has_volume(std::span<const LongVector> d, long double size) {
  const auto farthest = [&](const auto& distance) {
    return *std::max_element(d.begin(), d.end(), [&](const LongVector& a, const LongVector& b) {
      return distance(a) < distance(b);
    });
  };
  const LongVector end = farthest([&](const LongVector& p) { return (p - d[0]).squaredNorm(); });
  const LongVector line = (end - d[0]).stableNormalized();
  const auto off = [&](const LongVector& p) -> LongVector { return line.cross(p - d[0]); };
  LongVector n = off(farthest([&](const LongVector& p) { return off(p).squaredNorm(); }));
  const long double width = n.norm();
  if (!(width > 1e-15L * size)) return false;
  n /= width;
  const auto height = [&](const LongVector& p) { return std::abs(n.dot(p - d[0])); };
  return height(farthest(height)) > std::max(1e-14L, 1e-17L * size / width) * size;
}

// Whether the origin is inside the hull of points, as all planes through three of them say that
// have the others to one side; never in a hull without volume.
inline bool holds_origin(std::span<const LongVector> d) {
  long double size = 0;
  for (const LongVector& p : d) size = std::max(size, p.cwiseAbs().maxCoeff());
  if (!has_volume(d, size)) return false;
  for (std::size_t i = 0; i < d.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      for (std::size_t k = 0; k < j; ++k) {
        LongVector n = (d[j] - d[i]).cross(d[k] - d[i]);
        const long double length = n.norm();
        if (!(length > 1e-15L * size * size)) continue;
        n /= length;
        long double low = 0, high = 0;
        for (const LongVector& p : d) {
          low = std::min(low, n.dot(p - d[i]));
          high = std::max(high, n.dot(p - d[i]));
        }
        const long double error = 1e-16L * size;
        const long double origin = -n.dot(d[i]);
        if (low >= -error && origin < low) return false;
        if (high <= error && origin > high) return false;
      }
    }
  }
  return true;
}

// From the hull of points to a triangle that is relative to them; 0 where they touch.
inline LongVector between_of_hull(const LongShape& hull, const LongTriangle& triangle) {
  std::vector<LongVector> differences;
  for (const LongTriangle& point : hull.core) {
    for (const LongVector& corner : triangle) differences.push_back(corner - point[0]);
  }
  const LongVector closest = closest_of_hull(differences);
  // All of it beyond a plane: much faster than to look whether the origin is inside.
  const bool is_apart = std::all_of(differences.begin(), differences.end(),
                                    [&](const LongVector& d) { return d.dot(closest) > 0; });
  if (!is_apart && holds_origin(differences)) return LongVector::Zero();
  return closest;
}

// Whether anything is left of the triangle when the six sides of a box have cut it.
inline bool overlaps(const LongShape& box, const LongTriangle& triangle) {
  std::vector<LongVector> left(triangle.begin(), triangle.end());
  for (std::size_t k = 0; k < 3; ++k) {
    for (const long double side : {-1.0L, 1.0L}) {
      const auto depth = [&](const LongVector& p) {
        return box.half[k] - side * box.axis[k].dot(p - box.center);
      };
      std::vector<LongVector> kept;
      for (std::size_t i = 0; i < left.size(); ++i) {
        const LongVector& a = left[i];
        const LongVector& b = left[(i + 1) % left.size()];
        if (depth(a) >= 0) kept.push_back(a);
        if ((depth(a) >= 0) != (depth(b) >= 0)) {
          kept.push_back(a + depth(a) / (depth(a) - depth(b)) * (b - a));
        }
      }
      left = kept;
    }
  }
  return !left.empty();
}

// Whether the segment from corner 0 to corner 1 passes through the triangle.
inline bool crosses(const LongTriangle& segment, const LongTriangle& triangle) {
  const auto& [a, b, c] = triangle;
  const LongVector n = (b - a).cross(c - a);
  if ((segment[0] - a).dot(n) * (segment[1] - a).dot(n) > 0) return false;
  const LongVector along = segment[1] - segment[0];
  const auto side = [&](const LongVector& p, const LongVector& q) {
    return (p - segment[0]).cross(q - segment[0]).dot(along);
  };
  const long double x = side(a, b), y = side(b, c), z = side(c, a);
  return (x > 0 && y > 0 && z > 0) || (x < 0 && y < 0 && z < 0);
}

// From the core, `moved` from where it started, to the triangle; 0 where they touch.
inline LongVector between(const LongShape& shape, const LongVector& moved,
                          const LongTriangle& triangle) {
  LongTriangle relative;
  for (std::size_t c = 0; c < 3; ++c) relative[c] = triangle[c] - moved;
  if (shape.is_hull) return between_of_hull(shape, relative);
  if (shape.is_solid && overlaps(shape, relative)) return LongVector::Zero();
  if (!shape.is_solid && crosses(shape.core[0], relative)) return LongVector::Zero();
  LongVector shortest = between_in_extended_precision(shape.core[0], relative);
  for (std::size_t i = 1; i < shape.core.size(); ++i) {
    const LongVector other = between_in_extended_precision(shape.core[i], relative);
    if (other.squaredNorm() < shortest.squaredNorm()) shortest = other;
  }
  return shortest;
}

// The distance of the core.
inline long double distance(const LongShape& shape, const LongVector& moved,
                            const LongTriangle& triangle) {
  return between(shape, moved, triangle).norm();
}

// The least distance on the way between two times. It is convex in time: a golden section.
inline long double least_distance(const LongShape& shape, const LongVector& direction,
                                  long double from, long double to, const LongTriangle& triangle) {
  constexpr long double kGolden = 0.6180339887498948482L;
  const auto at = [&](long double s) { return distance(shape, s * direction, triangle); };
  long double low = from, high = to;
  long double least = at(low);
  if (!(high > low)) return least;
  least = std::min(least, at(high));
  long double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
  long double of_a = at(a), of_b = at(b);
  for (int i = 0; i < 60 && least > 0; ++i) {
    least = std::min({least, of_a, of_b});
    if (of_a < of_b) {
      high = std::exchange(b, a);
      of_b = of_a;
      a = high - kGolden * (high - low);
      of_a = at(a);
    } else {
      low = std::exchange(a, b);
      of_a = of_b;
      b = low + kGolden * (high - low);
      of_b = at(b);
    }
  }
  return least;
}

// The same on the way from 0.
inline long double least_distance(const LongShape& shape, const LongVector& direction,
                                  long double to, const LongTriangle& triangle) {
  return least_distance(shape, direction, 0, to, triangle);
}

/// A triangle, in a ball that rules most of them out.
struct BoundedTriangle {
  explicit BoundedTriangle(const LongTriangle& triangle) : corner(triangle) {
    center = (corner[0] + corner[1] + corner[2]) / 3;
    for (const LongVector& c : corner) radius = std::max(radius, (c - center).norm());
  }

  LongTriangle corner;
  LongVector center;
  long double radius = 0;
};

/// Those of a tree, in object space.
inline std::vector<BoundedTriangle> bounded_triangles(const Tree& tree) {
  const long double scale = std::ldexp(1.0L, BoundTree::of(tree).scale_exponent());
  std::vector<BoundedTriangle> triangles;
  for (const Triangle& triangle : all_triangles(tree)) {
    LongTriangle in_object;
    for (std::size_t c = 0; c < 3; ++c) {
      in_object[c] = scale * triangle.corner[c].cast<long double>() +
                     BoundTree::of(tree).frame().origin.cast<long double>();
    }
    triangles.emplace_back(in_object);
  }
  return triangles;
}

/// The least distance of one triangle on the way, or something above `enough`. Only where the
/// balls around both are so near is looked at, to see it to all digits on long ways, too.
inline long double least_of(const BoundedTriangle& item, const LongShape& shape,
                            const LongVector& direction, long double to, long double enough) {
  const LongVector w = item.center - shape.center;
  const long double dd = direction.squaredNorm();
  const long double s = dd > 0 ? std::clamp(w.dot(direction) / dd, 0.0L, to) : 0;
  const long double near = item.radius + shape.reach + enough;
  if ((w - s * direction).norm() > near) return std::numeric_limits<long double>::infinity();
  const long double around = dd > 0 ? 1.0625L * near / std::sqrt(dd) : 0;
  return least_distance(shape, direction, std::max(0.0L, s - around), std::min(to, s + around),
                        item.corner);
}

class Surface {
 public:
  explicit Surface(const Tree& tree) : Surface(bounded_triangles(tree)) {}
  explicit Surface(std::vector<BoundedTriangle> triangles) : triangles_(std::move(triangles)) {
    for (const BoundedTriangle& triangle : triangles_) {
      for (const LongVector& c : triangle.corner) size_ = std::max(size_, c.cwiseAbs().maxCoeff());
    }
  }

  /// The least distance of the whole surface on the way, or something above `enough`.
  [[nodiscard]] long double least(const LongShape& shape, const LongVector& direction,
                                  long double to, long double enough) const {
    long double best = std::numeric_limits<long double>::infinity();
    for (const BoundedTriangle& item : triangles_) {
      best = std::min(best, least_of(item, shape, direction, to, enough));
    }
    return best;
  }
  [[nodiscard]] long double size() const { return size_; }

 private:
  std::vector<BoundedTriangle> triangles_;
  long double size_ = 0;
};

inline LongTriangle long_triangle(const Triangle& triangle) {
  LongTriangle out;
  for (std::size_t c = 0; c < 3; ++c) out[c] = triangle.corner[c].cast<long double>();
  return out;
}

// How far the shape has to go along a direction of length 1 until it is beyond the triangle.
inline long double depth_along(const LongShape& shape, const LongVector& direction,
                               const LongTriangle& triangle) {
  long double highest = -std::numeric_limits<long double>::infinity(), lowest = -highest;
  for (const LongVector& corner : triangle) highest = std::max(highest, corner.dot(direction));
  for (const LongTriangle& part : shape.core) {
    for (const LongVector& corner : part) lowest = std::min(lowest, corner.dot(direction));
  }
  return highest - lowest + shape.radius;
}

/// Whether the shape comes as near to the triangle as its radius between two times. Where they are
/// apart along a direction, they stay so until the motion has closed that gap, so the search goes
/// on from there; where this gets nowhere, the least distance decides.
inline bool touches_between(const LongShape& shape, const LongVector& direction, long double from,
                            long double to, const LongTriangle& triangle) {
  long double s = from;
  for (int i = 0; i < 40; ++i) {
    const LongVector gap = between(shape, s * direction, triangle);
    const long double length = gap.norm();
    if (length <= shape.radius) return true;
    const LongVector along = -gap / length;  // the way back
    const long double apart = s * direction.dot(along) - depth_along(shape, along, triangle);
    if (!(apart > 0.5L * (length - shape.radius))) break;
    const long double speed = -direction.dot(along);
    if (speed <= 0) return false;
    s += apart / speed;
    if (s > to) return false;
  }
  return least_distance(shape, direction, s, to, triangle) <= shape.radius;
}

}  // namespace boxtree::test
