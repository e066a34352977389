// SPDX-License-Identifier: MIT
// Casts against distances in extended precision: over all triangles, and over all of the way, since
// the distance of a moving convex shape from a triangle is convex in t.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "runtime/tree/bound_tree.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/triangle_reference.h"

namespace boxtree {
namespace {

using cooker::SourceMesh;
using test::LongTriangle;
using test::LongVector;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// What cast.h allows, in units of the largest coordinate.
constexpr long double kDoubt = 0x1p-46L;

// A shape as triangles: a point, a segment, or the sides of a box; and a radius around them.
struct LongShape {
  std::vector<LongTriangle> core;
  long double radius = 0;
  LongVector center;
  long double reach = 0;  // of the core from its center
  bool is_solid = false;
  std::array<LongVector, 3> axis;
  std::array<long double, 3> half{};
};

LongShape long_shape(const Sphere& sphere) {
  const LongVector c = sphere.center.cast<long double>();
  return {{{c, c, c}}, sphere.radius, c, 0, false, {}, {}};
}

LongShape long_shape(const Capsule& capsule) {
  const LongVector a = capsule.start.cast<long double>(), b = capsule.end.cast<long double>();
  return {{{a, b, b}}, capsule.radius, (a + b) / 2, (b - a).norm() / 2, false, {}, {}};
}

LongShape long_shape(const OrientedBox& box) {
  LongShape shape;
  shape.center = box.center.cast<long double>();
  const auto& q = box.rotation;
  const Eigen::Quaternion<long double> turn =
      Eigen::Quaternion<long double>(q.w(), q.x(), q.y(), q.z()).normalized();
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    shape.axis[i] = turn * LongVector::Unit(k);
    shape.half[i] = box.half_extents[k];
  }
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

// Whether anything is left of the triangle when the six sides of a box have cut it.
bool overlaps(const LongShape& box, const LongTriangle& triangle) {
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
bool crosses(const LongTriangle& segment, const LongTriangle& triangle) {
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

// The distance of the core, `moved` from where it started.
long double distance(const LongShape& shape, const LongVector& moved,
                     const LongTriangle& triangle) {
  LongTriangle relative;
  for (std::size_t c = 0; c < 3; ++c) relative[c] = triangle[c] - moved;
  if (shape.is_solid && overlaps(shape, relative)) return 0;
  if (!shape.is_solid && crosses(shape.core[0], relative)) return 0;
  long double least = std::numeric_limits<long double>::infinity();
  for (const LongTriangle& side : shape.core) {
    least = std::min(least, test::distance_in_extended_precision(side, relative));
  }
  return least;
}

// The least distance on the way from 0 to `to`.
long double least_distance(const LongShape& shape, const LongVector& direction, long double to,
                           const LongTriangle& triangle) {
  const auto at = [&](long double s) { return distance(shape, s * direction, triangle); };
  long double low = 0, high = to;
  long double least = std::min(at(low), at(high));
  for (int i = 0; i < 60 && high > low; ++i) {
    const long double a = low + (high - low) * 0.382L, b = low + (high - low) * 0.618L;
    const long double of_a = at(a), of_b = at(b);
    least = std::min({least, of_a, of_b});
    if (of_a < of_b) {
      high = b;
    } else {
      low = a;
    }
  }
  return least;
}

class Surface {
 public:
  explicit Surface(const Tree& tree) {
    const long double scale = std::ldexp(1.0L, BoundTree::of(tree).scale_exponent());
    for (const Triangle& triangle : test::all_triangles(tree)) {
      Item item;
      item.center.setZero();
      for (std::size_t c = 0; c < 3; ++c) {
        item.corner[c] = scale * triangle.corner[c].cast<long double>() +
                         BoundTree::of(tree).frame().origin.cast<long double>();
        item.center += item.corner[c] / 3;
        size_ = std::max(size_, item.corner[c].cwiseAbs().maxCoeff());
      }
      for (const auto& c : item.corner) {
        item.radius = std::max(item.radius, (c - item.center).norm());
      }
      items_.push_back(item);
    }
  }

  /// The least distance of the whole surface on the way, or something above `enough`.
  [[nodiscard]] long double least(const LongShape& shape, const LongVector& direction,
                                  long double to, long double enough) const {
    long double best = std::numeric_limits<long double>::infinity();
    for (const Item& item : items_) {
      const LongVector w = item.center - shape.center;
      const long double dd = direction.squaredNorm();
      const long double s = dd > 0 ? std::clamp(w.dot(direction) / dd, 0.0L, to) : 0;
      if ((w - s * direction).norm() - item.radius - shape.reach > enough) continue;
      best = std::min(best, least_distance(shape, direction, to, item.corner));
    }
    return best;
  }
  [[nodiscard]] long double size() const { return size_; }

 private:
  struct Item {
    LongTriangle corner;
    LongVector center;
    long double radius = 0;
  };
  std::vector<Item> items_;
  long double size_ = 0;
};

LongTriangle long_triangle(const Triangle& triangle) {
  LongTriangle out;
  for (std::size_t c = 0; c < 3; ++c) out[c] = triangle.corner[c].cast<long double>();
  return out;
}

template <class Shape>
void check(const Tree& tree, const Surface& surface, const Shape& shape, const Motion& motion,
           long double t_max) {
  const CastResult hit = cast_closest(tree, shape, motion);
  ASSERT_TRUE(hit.ok());
  const LongShape exact = long_shape(shape);
  const LongVector direction = motion.direction.cast<long double>();
  const long double far = exact.center.cwiseAbs().maxCoeff();
  const long double size = surface.size() + 2 * (exact.reach + exact.radius) + far / 8;
  const long double doubt = kDoubt * size;
  const long double radius = exact.radius;
  if (!hit) {
    ASSERT_GT(surface.least(exact, direction, t_max, radius + doubt), radius);
    return;
  }
  ASSERT_LE(hit->t_lower, hit->t);
  ASSERT_GE(hit->t_lower, 0);
  if (hit->t_lower > 0) {  // nothing is touched before
    ASSERT_GE(surface.least(exact, direction, hit->t_lower, radius + doubt), radius * (1 - 1e-18L));
  }
  const Triangle named = test::require(tree.triangle(hit->face, hit->triangle));
  const LongTriangle triangle = long_triangle(named);
  // And something is by then.
  ASSERT_LE(least_distance(exact, direction, hit->t, triangle), radius + doubt);
  ASSERT_LE(distance(exact, LongVector(hit->t_lower * direction), triangle), radius + 4 * doubt);
  EXPECT_EQ(hit->initially_touching, hit->t == 0);
  // The point lies on the triangle and touches the shape.
  const LongVector point = hit->point.cast<long double>();
  ASSERT_LE(test::distance_in_extended_precision({point, point, point}, triangle), 4 * doubt);
  if (!hit->initially_touching) {
    ASSERT_LE(distance(exact, LongVector(hit->t_lower * direction), {point, point, point}),
              radius + 8 * doubt);
    ASSERT_LE(hit->normal.dot(motion.direction), 1e-6 * motion.direction.norm());
  }
  // Faces without area have no normal of their own.
  if (!hit->initially_touching || !is_degenerate(named)) {
    ASSERT_NEAR(hit->normal.norm(), 1, 1e-12);
  }
  // Any touch is one.
  const CastResult any = cast_any(tree, shape, motion);
  ASSERT_TRUE(any);
  ASSERT_GE(any->t_lower, hit->t_lower);
  // All of them hold the first.
  double first = kInfinity;
  ASSERT_EQ(test::require(cast_all(tree, shape, motion,
                                   [&](const CastHit& each) {
                                     first = std::min(first, each.t_lower);
                                     return motion.t_max;
                                   })),
            Visit::kComplete);
  ASSERT_EQ(first, hit->t_lower);
}

class Casts : public testing::TestWithParam<test::Encoding> {
 protected:
  double unit() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  Eigen::Vector3d vector() { return {unit(), unit(), unit()}; }

  template <class Body>
  void for_each_motion(int count, const Body& body) {
    for (const SourceMesh& mesh : test::all_kinds()) {
      SCOPED_TRACE(mesh.name);
      const test::CookedTree cooked = test::cook_tree(mesh, GetParam());
      const Surface surface(cooked.tree);
      const Eigen::AlignedBox3d box = cooked.tree.bounds();
      const double size = box.diagonal().norm();
      for (int i = 0; i < count; ++i) {
        SCOPED_TRACE(i);
        Eigen::Vector3d from = box.center() + vector().cwiseProduct(box.sizes());
        Eigen::Vector3d to = box.center() + 0.5 * vector().cwiseProduct(box.sizes());
        double t_max = 1.5;
        if (i % 7 == 1) from = to + 1e-3 * size * vector();
        if (i % 7 == 2) from = box.center() + 1e6 * size * vector().normalized();
        if (i % 7 == 3) to[i % 3] = from[i % 3];  // along the axes
        if (i % 7 == 4) to = from;
        if (i % 7 == 5) t_max = 0.4;
        body(cooked.tree, surface, from, Motion{to - from, t_max}, size,
             0.05 * size * std::pow(10.0, 2 * unit()), t_max);
        if (HasFatalFailure()) return;
      }
    }
  }

  std::mt19937_64 random_{11};
};

TEST_P(Casts, ASphereIsThatOfExtendedPrecision) {
  for_each_motion(14, [&](const Tree& tree, const Surface& surface, const Eigen::Vector3d& from,
                          const Motion& motion, double, double radius, double t_max) {
    check(tree, surface, Sphere{from, radius}, motion, t_max);
  });
}

TEST_P(Casts, ACapsuleIsThatOfExtendedPrecision) {
  for_each_motion(14, [&](const Tree& tree, const Surface& surface, const Eigen::Vector3d& from,
                          const Motion& motion, double size, double radius, double t_max) {
    check(tree, surface, Capsule{from, from + 0.1 * size * vector(), radius}, motion, t_max);
  });
}

TEST_P(Casts, ABoxIsThatOfExtendedPrecision) {
  for_each_motion(6, [&](const Tree& tree, const Surface& surface, const Eigen::Vector3d& from,
                          const Motion& motion, double, double radius, double t_max) {
    OrientedBox box;
    box.center = from;
    box.half_extents = radius * (vector() + Eigen::Vector3d::Constant(1.1));
    if (random_() % 3 != 0) box.rotation.coeffs() << unit(), unit(), unit(), unit();
    check(tree, surface, box, motion, t_max);
  });
}

INSTANTIATE_TEST_SUITE_P(Encodings, Casts,
                         testing::Values(test::Encoding{CodecId::kWide8, GeometryId::kExact},
                                         test::Encoding{CodecId::kWide4, GeometryId::kGrid},
                                         test::Encoding{CodecId::kPlainF32, GeometryId::kArrays}),
                         test::encoding_name);

}  // namespace
}  // namespace boxtree
