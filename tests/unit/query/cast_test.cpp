// SPDX-License-Identifier: MIT
// Casts against distances in extended precision: over all triangles, and over all of the way, since
// the distance of a moving convex shape from a triangle is convex in t.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "runtime/tree/bound_tree.h"
#include "tests/support/cooked.h"
#include "tests/support/infinity.h"
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
using test::require;
using test::Surface;

using test::kInfinity;
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
  bool is_named = false;
  ASSERT_EQ(test::require(cast_all(tree, shape, motion,
                                   [&](const CastHit& each) {
                                     first = std::min(first, each.t_lower);
                                     is_named |= each.t_lower == hit->t_lower &&
                                                 each.face.index == hit->face.index &&
                                                 each.triangle == hit->triangle;
                                     return motion.t_max;
                                   })),
            Visit::kComplete);
  ASSERT_EQ(first, hit->t_lower);
  ASSERT_TRUE(is_named);
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

// Of a few points: brute force over their differences takes the fourth power of their number.
TEST_P(Casts, AHullIsThatOfExtendedPrecision) {
  for_each_motion(2, [&](const Tree& tree, const Surface& surface, const Eigen::Vector3d& from,
                         const Motion& motion, double, double radius, double t_max) {
    std::vector<Eigen::Vector3d> points;
    const std::size_t kind = random_() % 4;
    for (std::size_t i = 0; i < 1 + random_() % 6; ++i) {
      Eigen::Vector3d point = radius * vector();
      if (kind == 1) point[2] = 0;  // flat
      if (kind == 2 && i % 2 == 1) point = points.back();
      points.push_back(point);
    }
    ConvexHull hull;
    hull.points = points;
    hull.position = from;
    if (random_() % 3 != 0) hull.rotation.coeffs() << unit(), unit(), unit(), unit();
    check(tree, surface, hull, motion, t_max);
  });
}

INSTANTIATE_TEST_SUITE_P(Encodings, Casts,
                         testing::Values(test::Encoding{CodecId::kWide8, GeometryId::kExact},
                                         test::Encoding{CodecId::kWide4, GeometryId::kGrid},
                                         test::Encoding{CodecId::kPlainF32, GeometryId::kArrays}),
                         test::encoding_name);

// Closest touches have the same bits in every codec, by vectors and without.
TEST(CastBits, AreThoseOfEveryCodec) {
  std::mt19937_64 random(23);
  const auto unit = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
  for (const SourceMesh& mesh : test::all_kinds()) {
    SCOPED_TRACE(mesh.name);
    std::vector<test::CookedTree> cooked;
    for (const test::Encoding& encoding : test::all_encodings()) {
      if (encoding.geometry != GeometryId::kGrid) cooked.push_back(test::cook_tree(mesh, encoding));
    }
    const Eigen::AlignedBox3d box = cooked[0].tree.bounds();
    const double size = box.diagonal().norm();
    for (int i = 0; i < 60; ++i) {
      SCOPED_TRACE(i);
      const auto vector = [&] { return Eigen::Vector3d(unit(), unit(), unit()); };
      const Eigen::Vector3d from = box.center() + vector().cwiseProduct(box.sizes());
      const Motion motion{box.center() + 0.3 * vector().cwiseProduct(box.sizes()) - from, 2};
      const double radius = 0.03 * size * std::pow(8.0, unit());
      OrientedBox turned;
      turned.center = from;
      turned.half_extents = radius * Eigen::Vector3d(1, 0.5, 0.25);
      turned.rotation.coeffs() << unit(), unit(), unit(), unit();
      const Capsule capsule{from, from + radius * vector(), radius / 2};
      std::vector<Eigen::Vector3d> points;
      for (int k = 0; k < 20; ++k) points.push_back(radius * vector());
      const ConvexHull hull{points, from, turned.rotation};
      const auto cast = [&](const Tree& tree) {
        return i % 4 == 0   ? cast_closest(tree, Sphere{from, radius}, motion)
               : i % 4 == 1 ? cast_closest(tree, capsule, motion)
               : i % 4 == 2 ? cast_closest(tree, turned, motion)
                            : cast_closest(tree, hull, motion);
      };
      const CastResult first = cast(cooked[0].tree);
      for (const test::CookedTree& other : cooked) {
        const CastResult hit = cast(other.tree);
        ASSERT_EQ(hit.has_value(), first.has_value());
        if (!hit) continue;
        ASSERT_EQ(hit->t, first->t);
        ASSERT_EQ(hit->t_lower, first->t_lower);
        ASSERT_EQ(hit->face.id, first->face.id);
        ASSERT_EQ(hit->triangle, first->triangle);
        ASSERT_EQ(hit->point, first->point);
        ASSERT_EQ(hit->normal, first->normal);
        ASSERT_EQ(hit->feature, first->feature);
      }
    }
  }
}

// A floor at z = 0 of two triangles, from -1 to 1, whose seam is the diagonal x = y.
SourceMesh floor_of_two() {
  SourceMesh mesh;
  mesh.name = "floor";
  mesh.positions.f32 = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
  mesh.faces = {{{0, 1, 2, cooker::kNoCorner}}, {{0, 2, 3, cooker::kNoCorner}}};
  return mesh;
}

// The bounds hold `t` and are as near to each other as cast.h says, for coordinates up to 8 and a
// speed of 1 or more.
void is_between(const CastHit& hit, double t) {
  EXPECT_LE(hit.t_lower, t);
  EXPECT_GE(hit.t, t);
  EXPECT_LE(hit.t - hit.t_lower, 4 * 8 * 0x1p-46);
}

class CastCases : public testing::TestWithParam<test::Encoding> {
 protected:
  const test::CookedTree floor_ = test::cook_tree(floor_of_two(), GetParam());
};

TEST_P(CastCases, OntoASeamOfCoplanarFaces) {
  const Sphere sphere{{0.25, 0.25, 3}, 0.5};
  const CastResult hit = cast_closest(floor_.tree, sphere, Motion{{0, 0, -1}});
  ASSERT_TRUE(hit);
  is_between(*hit, 2.5);
  EXPECT_EQ(hit->face.id, 0u);  // of both
  EXPECT_EQ(hit->normal, Eigen::Vector3d(0, 0, 1));
  EXPECT_NEAR((hit->point - Eigen::Vector3d(0.25, 0.25, 0)).norm(), 0, 1e-14);
}

TEST_P(CastCases, GrazingIsATouchAndPassingIsNone) {
  // Rolls along the floor from beyond its edge: touches as soon as it is above the edge.
  const Motion along{{1, 0, 0}};
  const CastResult graze = cast_closest(floor_.tree, Sphere{{-3, 0, 1}, 1}, along);
  ASSERT_TRUE(graze);
  EXPECT_LE(graze->t_lower, 2);
  EXPECT_GE(graze->t, 2);
  EXPECT_FALSE(cast_closest(floor_.tree, Sphere{{-3, 0, 1 + 1e-12}, 1}, along));
  const CastResult deeper = cast_closest(floor_.tree, Sphere{{-3, 0, 1 - 1e-12}, 1}, along);
  ASSERT_TRUE(deeper);
  EXPECT_LE(deeper->t_lower, 2);
}

TEST_P(CastCases, ParallelToWhatItLiesOn) {
  // A capsule and a box flat above the floor come down on it whole.
  const CastResult capsule =
      cast_closest(floor_.tree, Capsule{{-0.5, 0, 2}, {0.5, 0.25, 2}, 0.25}, Motion{{0, 0, -2}});
  ASSERT_TRUE(capsule);
  is_between(*capsule, 0.875);
  EXPECT_NEAR(capsule->normal.z(), 1, 1e-14);
  const CastResult box = cast_closest(
      floor_.tree, OrientedBox{{0, 0, 2}, {3, 3, 0.5}, {1, 0, 0, 0}}, Motion{{0, 0, -1}});
  ASSERT_TRUE(box);
  is_between(*box, 1.5);
  EXPECT_NEAR(box->normal.z(), 1, 1e-14);
  // A box that slides beside the floor misses it.
  EXPECT_FALSE(cast_closest(floor_.tree, OrientedBox{{-5, 0, 0.6}, {1, 1, 0.5}, {1, 0, 0, 0}},
                            Motion{{1, 0, 0}}));
}

// Down onto one cell of a slope, then on through it into others, of smaller ids, too.
TEST_P(CastCases, OfFacesInOnePlaneThatTouchedFirstIsNamed) {
  SourceMesh mesh;
  mesh.name = "slope";
  constexpr std::uint32_t kCells = 8;
  for (std::uint32_t i = 0; i <= kCells; ++i) {
    for (std::uint32_t j = 0; j <= kCells; ++j) {
      const std::uint32_t corner = i * (kCells + 1) + j;
      const auto x = static_cast<float>(i), y = static_cast<float>(j);
      mesh.positions.f32.insert(mesh.positions.f32.end(), {x, y, 0.25F * x + 0.125F * y});
      if (i == kCells || j == kCells) continue;
      mesh.faces.push_back({{corner, corner + kCells + 1, corner + kCells + 2, corner + 1}});
    }
  }
  const test::CookedTree slope = test::cook_tree(mesh, GetParam());
  std::mt19937_64 random(5);
  const auto unit = [&] { return std::uniform_real_distribution<double>(0, 1)(random); };
  for (int i = 0; i < 500; ++i) {
    OrientedBox box;
    box.center = Eigen::Vector3d(8 * unit(), 8 * unit(), 6 + unit());
    for (double& half : box.half_extents) half = 0.1 + 0.5 * unit();
    box.rotation = {unit(), unit(), unit(), unit()};
    const Motion motion{{unit() - 0.5, unit() - 0.5, -1}};
    const CastResult hit = cast_closest(slope.tree, box, motion);
    if (!hit) continue;
    std::tuple<double, std::uint32_t, std::uint32_t> first(kInfinity, 0, 0);
    const auto keep_first = [&](const CastHit& each) {
      first = std::min(first, std::tuple(each.t_lower, each.face.id, each.triangle));
      return motion.t_max;
    };
    ASSERT_TRUE(cast_all(slope.tree, box, motion, keep_first).ok());
    EXPECT_EQ(std::tuple(hit->t_lower, hit->face.id, hit->triangle), first) << i;
  }
}

TEST_P(CastCases, AShapeThatStaysTouchesWhatItHolds) {
  const Motion none;
  EXPECT_FALSE(cast_closest(floor_.tree, Sphere{{0, 0, 1}, 0.5}, none));
  const CastResult held = cast_closest(floor_.tree, Sphere{{0.5, 0, 0.25}, 0.5}, none);
  ASSERT_TRUE(held);
  EXPECT_TRUE(held->initially_touching);
  EXPECT_EQ(held->t, 0);
  EXPECT_EQ(held->t_lower, 0);
}

TEST_P(CastCases, AStartInContactIsTold) {
  for (const Eigen::Vector3d& away : {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 0, -1)}) {
    const CastResult hit = cast_closest(floor_.tree, Sphere{{0, 0, 0.1}, 0.5}, Motion{away});
    ASSERT_TRUE(hit);
    EXPECT_TRUE(hit->initially_touching);
    EXPECT_EQ(hit->t, 0);
  }
}

TEST_P(CastCases, FromAMillionDiagonalsAway) {
  const Eigen::Vector3d from(2e6, 1e6, 2e6);
  const CastResult hit = cast_closest(floor_.tree, Sphere{from, 0.125}, Motion{-from});
  ASSERT_TRUE(hit);
  // Its center is then 1/8 above the floor: at z = 1/8 of 2e6.
  EXPECT_LE(hit->t_lower, 1 - 0.125 / 2e6);
  EXPECT_GE(hit->t, 1 - 0.125 / 2e6);
  EXPECT_LT(hit->t - hit->t_lower, 1e-14);
}

// The corners of a cube with edges of 2, and what a hull does not need.
std::vector<Eigen::Vector3d> cube() {
  std::vector<Eigen::Vector3d> points;
  for (int k = 0; k < 8; ++k) {
    points.emplace_back((k & 1) != 0 ? 1 : -1, (k & 2) != 0 ? 1 : -1, (k & 4) != 0 ? 1 : -1);
  }
  points.emplace_back(0, 0, 0);
  points.emplace_back(0, 1, 1);
  points.push_back(points[3]);
  return points;
}

ConvexHull scaled_to(std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& half,
                     const Eigen::Vector3d& position) {
  for (Eigen::Vector3d& point : points) point = point.cwiseProduct(half);
  ConvexHull hull;
  hull.points = points;
  hull.position = position;
  return hull;
}

// Their distance stays 0 once they have touched: it does not tell how deep they are.
TEST_P(CastCases, ACapsuleWithoutRadiusThatMovesAlongItself) {
  for (const double radius : {0.0, 1e-16, 1e-14}) {
    for (const Eigen::Vector3d& along :
         {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0.5, 0.25, 1), Eigen::Vector3d(-1, 0.5, 0.5)}) {
      // Its lower end falls onto (0.25, 0.5, 0), inside of a face.
      const Eigen::Vector3d low = Eigen::Vector3d(0.25, 0.5, 0) + 2 * along;
      const CastResult hit =
          cast_closest(floor_.tree, Capsule{low, low + along, radius}, Motion{-along});
      ASSERT_TRUE(hit);
      EXPECT_LE(hit->t_lower, 2 - radius);
      EXPECT_GE(hit->t, 2 - 4 * radius);
      // Toward the face it moves by 1/2 or more.
      EXPECT_LE(hit->t - hit->t_lower, 2 * 4 * 8 * 0x1p-46);
      EXPECT_NEAR(hit->normal.z(), 1, 1e-12);
    }
  }
}

TEST_P(CastCases, AHullOntoASeamAndFlatOnIt) {
  std::vector<Eigen::Vector3d> points = cube();
  const ConvexHull hull = scaled_to(points, {0.5, 0.25, 0.5}, {0.25, 0.25, 3});
  const CastResult hit = cast_closest(floor_.tree, hull, Motion{{0, 0, -1}});
  ASSERT_TRUE(hit);
  is_between(*hit, 2.5);
  EXPECT_NEAR(hit->normal.z(), 1, 1e-14);
  // Along the seam, and down.
  const CastResult along = cast_closest(floor_.tree, hull, Motion{{0.25, 0.25, -4}});
  ASSERT_TRUE(along);
  is_between(*along, 2.5 / 4);
  // On its corner.
  ConvexHull turned = hull;
  turned.rotation = {0.8, 0.3, 0.4, 0.2};
  const CastResult corner = cast_closest(floor_.tree, turned, Motion{{0, 0, -1}});
  const CastResult box =
      cast_closest(floor_.tree, OrientedBox{{0.25, 0.25, 3}, {0.5, 0.25, 0.5}, turned.rotation},
                   Motion{{0, 0, -1}});
  ASSERT_TRUE(corner && box);
  EXPECT_NEAR(corner->t, box->t, 1e-13);
  EXPECT_NEAR((corner->point - box->point).norm(), 0, 1e-13);
  EXPECT_NEAR((corner->normal - box->normal).norm(), 0, 1e-13);
}

TEST_P(CastCases, AHullThatGrazesOrPasses) {
  std::vector<Eigen::Vector3d> points = cube();
  const Motion along{{1, 0, 0}};
  const CastResult graze =
      cast_closest(floor_.tree, scaled_to(points, {1, 1, 0.5}, {-5, 0, 0.5}), along);
  ASSERT_TRUE(graze);
  EXPECT_LE(graze->t_lower, 3);
  EXPECT_GE(graze->t, 3);
  EXPECT_LT(graze->t - graze->t_lower, 1e-12);
  ConvexHull hull{points, {-5, 0, 0.5 + 1e-12}, {1, 0, 0, 0}};
  EXPECT_FALSE(cast_closest(floor_.tree, hull, along));
  hull.position[2] = 0.5 - 1e-12;
  const CastResult deeper = cast_closest(floor_.tree, hull, along);
  ASSERT_TRUE(deeper);
  is_between(*deeper, 3);
  EXPECT_NEAR(deeper->normal.x(), -1, 1e-12);
}

TEST_P(CastCases, AHullOfOnePointOrInOnePlane) {
  const std::vector<Eigen::Vector3d> point = {{3, 3, 3}};
  ConvexHull hull;
  hull.points = point;
  hull.position = {-2.75, -2.5, 0};
  const CastResult hit = cast_closest(floor_.tree, hull, Motion{{0, 0, -1}});
  ASSERT_TRUE(hit);
  is_between(*hit, 3);
  EXPECT_NEAR(hit->normal.z(), 1, 1e-14);
  // A plate upright, and one in the plane of the floor that slides into it.
  const std::vector<Eigen::Vector3d> plate = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {1, 0, 1}};
  hull.points = plate;
  hull.position = {0, 0.5, 2};
  const CastResult upright = cast_closest(floor_.tree, hull, Motion{{0, 0, -1}});
  ASSERT_TRUE(upright);
  is_between(*upright, 1);
  const std::vector<Eigen::Vector3d> flat = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}};
  hull.points = flat;
  hull.position = {-4, 0, 0};
  const CastResult slid = cast_closest(floor_.tree, hull, Motion{{1, 0, 0}});
  ASSERT_TRUE(slid);
  is_between(*slid, 2);
  EXPECT_LE(slid->normal.x(), 1e-6);
}

// Found by random casts: an edge that lies in the plane of a face of the hull but for what f32
// rounds. The line between two edges that are next to each other did not tell that the hull's third
// point is nearer, and t was 1.5e-9 late.
TEST_P(CastCases, AHullWhoseFaceIsNearlyParallelToAnEdge) {
  SourceMesh mesh;
  mesh.positions.f32 = {-2e30f, -3e30f, 3e30f, 3e30f, -1e30f, 0, 2e30f, -2e30f, 3e30f};
  mesh.faces = {{{0, 1, 2, cooker::kNoCorner}}};
  const test::CookedTree cooked = test::cook_tree(mesh, GetParam());
  const std::vector<Eigen::Vector3d> points = {
      {0, 0, -2.300000072388104e29},
      {-2.300000072388104e29, 2.2999999590513086e30, 1.1499999795256543e30},
      {0, -2.2999999590513086e30, 0},
      {0, 0, 0},
      {2.2999999590513086e30, 2.2999999590513086e30, 2.2999999590513086e30},
      {1.1499999795256543e30, 1.1499999795256543e30, 2.2999999590513086e30}};
  const ConvexHull hull{points,
                        {1.779147379369303e+30, 3.6104262897228754e+30, -7.610426467654169e+30},
                        {1, 0, 0, 0}};
  const CastResult hit =
      cast_closest(cooked.tree, hull,
                   Motion{{-4.076973645997261e+29, -5.261846226941239e+30, 8.587556375520465e+30}});
  ASSERT_TRUE(hit);
  EXPECT_LE(hit->t - hit->t_lower, 6e-14);
  if (GetParam().geometry == GeometryId::kGrid) return;  // is another triangle
  // By exact arithmetic: of the Minkowski difference of hull and triangle.
  EXPECT_LE(hit->t_lower, 0.828890762024);
  EXPECT_GE(hit->t, 0.828890762023);
}

// The same of many, of coordinates that are few and rounded: one of 200 was late.
TEST_P(CastCases, HullsOfFewCoordinatesAreNotLate) {
  std::mt19937 random(5);
  const auto number = [&](int most, float unit) {
    return static_cast<float>(static_cast<int>(random() % static_cast<unsigned>(2 * most + 1)) -
                              most) *
           unit;
  };
  const auto point = [&](int most, float unit) {
    const double x = number(most, unit), y = number(most, unit);
    return Eigen::Vector3d(x, y, number(most, unit));
  };
  SourceMesh mesh;
  for (std::uint32_t i = 0; i < 60; i += 3) {
    for (int k = 0; k < 9; ++k) mesh.positions.f32.push_back(number(10, 0.1f));
    mesh.faces.push_back({{i, i + 1, i + 2, cooker::kNoCorner}});
  }
  const test::CookedTree cooked = test::cook_tree(mesh, GetParam());
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    std::vector<Eigen::Vector3d> points(static_cast<std::size_t>(4 + i % 6));
    for (Eigen::Vector3d& p : points) p = point(3, 0.23f);
    const Motion motion{point(9, 1)};
    if (motion.direction.isZero(0)) continue;
    const ConvexHull hull{points, point(9, 0.1f) - motion.direction, {1, 0, 0, 0}};
    const CastResult hit = cast_closest(cooked.tree, hull, motion);
    if (!hit || hit->initially_touching) continue;
    ++hits;
    const double nearer = (hit->t - hit->t_lower) * std::abs(hit->normal.dot(motion.direction));
    ASSERT_LE(nearer, 4 * 0x1p-46 * 12) << i;  // no coordinate is larger
  }
  EXPECT_GT(hits, 1000);
}

TEST_P(CastCases, AHullThatStaysOrStartsInContact) {
  std::vector<Eigen::Vector3d> points = cube();
  const ConvexHull hull = scaled_to(points, {0.25, 0.25, 0.25}, {0, 0, 0.125});
  for (const Eigen::Vector3d& way : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, 0, 1)}) {
    const CastResult hit = cast_closest(floor_.tree, hull, Motion{way});
    ASSERT_TRUE(hit);
    EXPECT_TRUE(hit->initially_touching);
    EXPECT_EQ(hit->t, 0);
    EXPECT_NEAR((hit->normal - Eigen::Vector3d(0, 0, 1)).norm(), 0, 1e-14);
  }
  EXPECT_FALSE(cast_closest(floor_.tree, {points, {0, 0, 0.5}, {1, 0, 0, 0}}, Motion{}));
}

TEST_P(CastCases, AHullFromAMillionDiagonalsAway) {
  std::vector<Eigen::Vector3d> points = cube();
  const Eigen::Vector3d from(2e6, 1e6, 2e6);
  const CastResult hit =
      cast_closest(floor_.tree, scaled_to(points, {0.125, 0.125, 0.125}, from), Motion{-from});
  ASSERT_TRUE(hit);
  EXPECT_LE(hit->t_lower, 1 - 0.125 / 2e6);
  EXPECT_GE(hit->t, 1 - 0.125 / 2e6);
  EXPECT_LT(hit->t - hit->t_lower, 1e-14);
}

// Faces around the origin, each half as large as the one before: what separates them in single
// precision has squares below its smallest number.
TEST(CastAtTinyFaces, TouchesAllOfThem) {
  constexpr std::uint32_t kFaces = 100;
  SourceMesh mesh;
  mesh.name = "halves";
  for (std::uint32_t i = 0; i < kFaces; ++i) {
    const float size = std::ldexp(1.0F, -static_cast<int>(i));
    for (const float x : {1.0F, 1.0F, 0.5F, 1.25F, 1.0F, 0.625F, 1.0F, 1.125F, 0.75F}) {
      mesh.positions.f32.push_back(size * x);
    }
    mesh.faces.push_back({{3 * i, 3 * i + 1, 3 * i + 2, cooker::kNoCorner}});
  }
  for (const test::Encoding& encoding : test::all_encodings()) {
    if (encoding.geometry == GeometryId::kGrid) continue;  // where they are one place
    SCOPED_TRACE(codec_name(encoding.codec));
    const test::CookedTree cooked = test::cook_tree(mesh, encoding);
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int i = 0; i < 200; ++i) {
      const Sphere sphere{0.3 * Eigen::Vector3d(unit(random), unit(random), unit(random)), 0.05};
      const Motion motion{-sphere.center, 1.5};
      std::uint32_t touched = 0;
      ASSERT_TRUE(cast_all(cooked.tree, sphere, motion, [&](const CastHit& hit) {
        touched += hit.face.id >= 30 ? 1u : 0u;
        return motion.t_max;
      }));
      ASSERT_EQ(touched, kFaces - 30) << i;
    }
  }
}

// What slides along the plane of a face, in touch to within rounding, comes no nearer: it is told
// where it begins to touch, not where rounding would have it touch by, behind the face.
TEST(CastAlongAFace, IsNotLate) {
  std::mt19937_64 random(12);
  const auto unit = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
  int hits = 0;
  for (int i = 0; i < 500; ++i) {
    SCOPED_TRACE(i);
    const double at = 4 * unit();
    SourceMesh mesh;
    mesh.positions.precision = cooker::Precision::kF64;
    for (int corner = 0; corner < 3; ++corner) {
      mesh.positions.f64.insert(mesh.positions.f64.end(), {at, 3 * unit(), 3 * unit()});
    }
    mesh.faces = {{{0, 1, 2, cooker::kNoCorner}}};
    const test::CookedTree cooked = test::cook_tree(mesh, CodecId::kWide8);
    const double radius = std::exp2(2 * unit());
    const Eigen::Vector3d from(at - radius, 3 * unit(), 3 * unit());
    const Motion motion{{0, unit(), unit()}, 1e12};
    const Eigen::Vector3d half(0, unit(), unit());
    const auto check = [&](const CastResult& hit, const auto& overlap_at) {
      ASSERT_TRUE(hit.ok());
      if (!hit) return;
      ++hits;
      ASSERT_LE(hit->t_lower, hit->t);
      bool touches = false;
      ASSERT_TRUE(
          overlap_at(from + hit->t * motion.direction, radius + 0x1p-42, [&](const FaceRef&) {
            touches = true;
            return false;
          }).ok());
      EXPECT_TRUE(touches) << hit->t_lower << " " << hit->t;
      if (!hit->initially_touching) {
        EXPECT_LT((hit->t - hit->t_lower) * motion.direction.norm(), 1e-3);
      }
    };
    check(cast_closest(cooked.tree, Sphere{from, radius}, motion),
          [&](const Eigen::Vector3d& center, double reach, const auto& visit) {
            return overlap_sphere(cooked.tree, center, reach, visit);
          });
    check(
        cast_closest(cooked.tree, Capsule{from - half, from + half, radius}, motion),
        [&](const Eigen::Vector3d& center, double reach, const auto& visit) {
          return overlap_capsule(cooked.tree, Capsule{center - half, center + half, reach}, visit);
        });
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(hits, 200);
}

TEST(CastIntoAVertex, TouchesItFirst) {
  SourceMesh mesh;
  mesh.name = "pyramid";
  mesh.positions.f32 = {0, 0, 1, 1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1, 0};
  for (std::uint32_t i = 0; i < 4; ++i) {
    mesh.faces.push_back({{0, 1 + i, 1 + (i + 1) % 4, cooker::kNoCorner}});
  }
  for (const test::Encoding& encoding : test::all_encodings()) {
    const test::CookedTree cooked = test::cook_tree(mesh, encoding);
    const CastResult hit = cast_closest(cooked.tree, Sphere{{0, 0, 4}, 1}, Motion{{0, 0, -1}});
    ASSERT_TRUE(hit);
    EXPECT_LE(hit->t_lower, 2);
    EXPECT_GE(hit->t, 2);
    EXPECT_LT(hit->t - hit->t_lower, 1e-13);
    EXPECT_EQ(hit->face.id, 0u);
    EXPECT_EQ(hit->feature, Feature::kVertex);
    EXPECT_NEAR((hit->point - Eigen::Vector3d(0, 0, 1)).norm(), 0, 1e-13);
    EXPECT_NEAR((hit->normal - Eigen::Vector3d(0, 0, 1)).norm(), 0, 1e-13);
  }
}

// The normal is one along which the hull is beyond the triangle when they touch, whatever faces of
// their difference look along the motion; the feature is where the point lies.
TEST(CastHull, TheNormalPartsItFromTheTriangleThatItTouches) {
  std::mt19937 random(4);
  const auto integer = [&](int most) {
    return static_cast<int>(random() % static_cast<unsigned>(2 * most + 1)) - most;
  };
  const auto vector = [&](int most) {
    const int x = integer(most), y = integer(most), z = integer(most);
    return Eigen::Vector3d(x, y, z);
  };
  int touched = 0;
  for (int turn = 0; turn < 60; ++turn) {
    SourceMesh mesh;
    mesh.name = "triangle";
    for (int i = 0; i < 9; ++i) mesh.positions.f32.push_back(static_cast<float>(integer(2)));
    mesh.faces = {{{0, 1, 2, cooker::kNoCorner}}};
    const test::CookedTree cooked = test::cook_tree(mesh, CodecId::kWide8);
    const Triangle triangle = require(cooked.tree.triangle({0, 0}, 0));
    for (int i = 0; i < 200; ++i) {
      std::vector<Eigen::Vector3d> points(2 + random() % 5);
      for (Eigen::Vector3d& point : points) point = vector(2);
      ConvexHull hull;
      hull.points = points;
      hull.position = vector(4);
      Motion motion{vector(4)};
      if (motion.direction.isZero(0)) continue;
      const CastResult hit = cast_closest(cooked.tree, hull, motion);
      if (!hit || hit->initially_touching) continue;
      ++touched;
      double highest = -kInfinity, lowest = kInfinity;
      for (const Eigen::Vector3d& corner : triangle.corner) {
        highest = std::max(highest, hit->normal.dot(corner));
      }
      for (const Eigen::Vector3d& point : points) {
        lowest =
            std::min(lowest, hit->normal.dot(point + hull.position + hit->t * motion.direction));
      }
      EXPECT_LE(highest - lowest, 1e-9) << turn << " " << i;
      EXPECT_LE(hit->normal.dot(motion.direction), 0);
      if (hit->feature == Feature::kFace && !is_degenerate(triangle)) {
        EXPECT_NEAR(hit->normal.dot(hit->face_normal), 1, 1e-9);
      }
    }
  }
  EXPECT_GT(touched, 300);
}

INSTANTIATE_TEST_SUITE_P(Encodings, CastCases, testing::ValuesIn(test::all_encodings()),
                         test::encoding_name);

}  // namespace
}  // namespace boxtree
