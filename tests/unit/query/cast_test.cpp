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
#include "tests/support/shape_reference.h"

namespace boxtree {
namespace {

using cooker::SourceMesh;
using test::distance;
using test::least_distance;
using test::long_shape;
using test::long_triangle;
using test::LongShape;
using test::LongTriangle;
using test::LongVector;
using test::Surface;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// What cast.h allows, in units of the largest coordinate.
constexpr long double kDoubt = 0x1p-46L;

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
