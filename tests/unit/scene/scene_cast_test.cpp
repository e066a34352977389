// SPDX-License-Identifier: MIT
// Casts in scenes against distances in extended precision, over all placed triangles and all of the
// way.
#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "runtime/scene/bound_scene.h"
#include "tests/support/infinity.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/scenes.h"
#include "tests/support/shape_reference.h"

namespace boxtree {
namespace {

using test::BoundedTriangle;
using test::CookedScene;
using test::long_shape;
using test::long_triangle;
using test::LongShape;
using test::LongTriangle;
using test::LongVector;
using test::require;
using test::Surface;
using test::WorldTriangle;

using test::kInfinity;

Surface surface_of(const std::vector<WorldTriangle>& triangles) {
  std::vector<BoundedTriangle> bounded;
  for (const WorldTriangle& each : triangles) bounded.emplace_back(long_triangle(each.triangle));
  return Surface(bounded);
}

// `doubt`: what coordinates of the scene may be off.
template <class Shape>
void check(const Scene& scene, const Surface& surface, const Shape& shape, const Motion& motion,
           long double doubt) {
  const SceneCastResult hit = cast_closest(scene, shape, motion);
  ASSERT_TRUE(hit.ok()) << hit.error().message();
  const LongShape exact = long_shape(shape);
  const LongVector direction = motion.direction.cast<long double>();
  const long double radius = exact.radius;
  const SceneCastResult any = cast_any(scene, shape, motion);
  ASSERT_EQ(any.has_value(), hit.has_value());
  std::size_t visited = 0;
  double first = kInfinity;
  std::uint32_t first_id = 0;
  ASSERT_EQ(require(cast_all(scene, shape, motion,
                             [&](const SceneCastHit& each) {
                               ++visited;
                               const std::uint32_t id = require(scene.info(each.instance)).id;
                               if (each.t_lower < first || (each.t_lower == first && id < first_id))
                                 first_id = id;
                               first = std::min(first, each.t_lower);
                               return motion.t_max;
                             })),
            Visit::kComplete);
  ASSERT_EQ(visited != 0, hit.has_value());
  if (!hit) {
    ASSERT_GT(surface.least(exact, direction, motion.t_max, radius), radius - doubt);
    return;
  }
  ASSERT_GE(any->t_lower, hit->t_lower);
  ASSERT_EQ(first, hit->t_lower);
  ASSERT_EQ(first_id, require(scene.info(hit->instance)).id);
  ASSERT_LE(hit->t_lower, hit->t);
  if (hit->t_lower > 0) {  // nothing is touched before
    ASSERT_GE(surface.least(exact, direction, hit->t_lower, radius), radius - doubt);
  }
  const LongTriangle triangle =
      long_triangle(require(scene.triangle({hit->instance, hit->face}, hit->triangle)));
  ASSERT_LE(test::least_distance(exact, direction, hit->t, triangle), radius + doubt);
  ASSERT_LE(test::distance(exact, LongVector(hit->t_lower * direction), triangle), radius + doubt);
  const LongVector point = hit->point.cast<long double>();
  ASSERT_LE(test::distance_in_extended_precision({point, point, point}, triangle), doubt);
  EXPECT_EQ(hit->initially_touching, hit->t == 0);
  if (!hit->initially_touching) {
    ASSERT_LE(test::distance(exact, LongVector(hit->t_lower * direction), {point, point, point}),
              radius + doubt);
    ASSERT_LE(hit->normal.dot(motion.direction), 1e-6 * motion.direction.norm());
    ASSERT_NEAR(hit->normal.norm(), 1, 1e-12);
  }
}

class SceneCasts : public testing::TestWithParam<CodecId> {
 protected:
  SceneCasts()
      : cooked_(test::cook_scene(
            {test::sphere(8, 12), test::torus(10, 14), test::terrain(6, 1), test::soup(40, 3)},
            test::random_parts(24, 4, 5, 3, 11), {GetParam()})),
        scene_(require(Scene::bind(cooked_.file))) {}

  double unit() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  Eigen::Vector3d vector() { return {unit(), unit(), unit()}; }

  // Before and after moving what moves.
  template <class Body>
  void for_each_motion(int count, const Body& body) {
    for (const bool moved : {false, true}) {
      for (const BoundScene::Moving& moving : BoundScene::of(scene_).moving()) {
        if (moved) {
          ASSERT_TRUE(scene_.update(moving.instance, test::random_pose(random_, 4, true)).ok());
        }
      }
      const Surface surface = surface_of(test::world_triangles(cooked_, scene_));
      for (int i = 0; i < count; ++i) {
        SCOPED_TRACE(i);
        Eigen::Vector3d from = 6 * vector(), to = 5 * vector();
        double t_max = 1.5;
        if (i % 5 == 1) from = to + 1e6 * vector().normalized();
        if (i % 5 == 2) to[i % 3] = from[i % 3];  // along the axes
        if (i % 5 == 3) to = from;
        if (i % 5 == 4) t_max = 0.4;
        const double radius = 0.2 * std::pow(8.0, unit());
        body(surface, from, Motion{to - from, t_max}, radius,
             0x1p-44L * (20 + from.cwiseAbs().maxCoeff()));
        if (HasFatalFailure()) return;
      }
    }
  }

  std::mt19937_64 random_{5};
  CookedScene cooked_;
  Scene scene_;
};

TEST_P(SceneCasts, ASphereIsThatOfExtendedPrecision) {
  for_each_motion(20, [&](const Surface& surface, const Eigen::Vector3d& from, const Motion& motion,
                          double radius, long double doubt) {
    check(scene_, surface, Sphere{from, radius}, motion, doubt);
  });
}

TEST_P(SceneCasts, ACapsuleIsThatOfExtendedPrecision) {
  for_each_motion(20, [&](const Surface& surface, const Eigen::Vector3d& from, const Motion& motion,
                          double radius, long double doubt) {
    check(scene_, surface, Capsule{from, from + vector(), radius}, motion, doubt);
  });
}

TEST_P(SceneCasts, ABoxIsThatOfExtendedPrecision) {
  for_each_motion(10, [&](const Surface& surface, const Eigen::Vector3d& from, const Motion& motion,
                          double radius, long double doubt) {
    OrientedBox box;
    box.center = from;
    box.half_extents = radius * (vector() + Eigen::Vector3d::Constant(1.1));
    box.rotation.coeffs() << unit(), unit(), unit(), unit();
    check(scene_, surface, box, motion, doubt);
  });
}

TEST_P(SceneCasts, AHullIsThatOfExtendedPrecision) {
  for_each_motion(5, [&](const Surface& surface, const Eigen::Vector3d& from, const Motion& motion,
                         double radius, long double doubt) {
    std::vector<Eigen::Vector3d> points(4 + random_() % 4);
    for (Eigen::Vector3d& point : points) point = radius * (Eigen::Vector3d(2, 0, 0) + vector());
    ConvexHull hull;
    hull.points = points;
    hull.position = from;
    if (random_() % 3 != 0) hull.rotation.coeffs() << unit(), unit(), unit(), unit();
    check(scene_, surface, hull, motion, doubt);
  });
}

INSTANTIATE_TEST_SUITE_P(Codecs, SceneCasts,
                         testing::Values(CodecId::kPlainF32, CodecId::kPackedF16, CodecId::kWide8,
                                         CodecId::kWide4),
                         test::test_name);

// Answers have the same bits in every codec.
TEST(SceneCastBits, AreThoseOfEveryCodec) {
  const std::vector<cooker::SourceMesh> meshes = {test::sphere(8, 12), test::torus(10, 14)};
  const cooker::SceneParts parts = test::random_parts(30, 2, 5, 1, 3);
  std::vector<CookedScene> cooked;
  std::vector<Scene> scenes;
  for (const CodecId codec : {CodecId::kWide8, CodecId::kPlainF32, CodecId::kPackedF64}) {
    cooked.push_back(test::cook_scene(meshes, parts, {codec}));
    scenes.push_back(require(Scene::bind(cooked.back().file)));
  }
  std::mt19937_64 random(3);
  const auto unit = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
  const auto vector = [&] { return Eigen::Vector3d(unit(), unit(), unit()); };
  std::size_t hits = 0;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d from = 6 * vector();
    const Motion motion{4 * vector() - from, 1.2};
    OrientedBox box;
    box.center = from;
    box.half_extents = {0.1, 0.2, 0.3};
    box.rotation.coeffs() << unit(), unit(), unit(), unit();
    const Capsule capsule{from, from + 0.5 * vector(), 0.1};
    const std::vector<Eigen::Vector3d> points = {Eigen::Vector3d::Zero(), 0.5 * vector(),
                                                 0.5 * vector(), 0.5 * vector(), 0.5 * vector()};
    ConvexHull hull;
    hull.points = points;
    hull.position = from;
    hull.rotation = box.rotation;
    const auto cast = [&](const Scene& scene) {
      return i % 4 == 0   ? cast_closest(scene, Sphere{from, 0.2}, motion)
             : i % 4 == 1 ? cast_closest(scene, capsule, motion)
             : i % 4 == 2 ? cast_closest(scene, box, motion)
                          : cast_closest(scene, hull, motion);
    };
    const SceneCastResult first = cast(scenes[0]);
    for (const Scene& other : scenes) {
      const SceneCastResult hit = cast(other);
      ASSERT_EQ(hit.has_value(), first.has_value());
      if (!hit) continue;
      ++hits;
      ASSERT_EQ(hit->t, first->t);
      ASSERT_EQ(hit->t_lower, first->t_lower);
      ASSERT_EQ(hit->instance, first->instance);
      ASSERT_EQ(hit->face.id, first->face.id);
      ASSERT_EQ(hit->point, first->point);
      ASSERT_EQ(hit->normal, first->normal);
    }
  }
  EXPECT_GT(hits, 100u);
}

// Whatever poses do, what is touched is found.
TEST(SceneCastCases, PlacementsOfEveryKind) {
  for (const Pose& pose : test::extreme_poses()) {
    SCOPED_TRACE(testing::Message() << pose.matrix());
    cooker::SceneParts parts;
    parts.instances.emplace_back().pose = pose;
    const CookedScene cooked = test::cook_scene({test::sphere(6, 8)}, parts);
    const Result<Scene> bound = Scene::bind(cooked.file);
    ASSERT_TRUE(bound);
    const std::vector<WorldTriangle> triangles = test::world_triangles(cooked, *bound);
    double largest = 0;
    for (const WorldTriangle& each : triangles) {
      for (const auto& corner : each.triangle.corner) {
        largest = std::max(largest, corner.cwiseAbs().maxCoeff());
      }
    }
    // At each of some triangles, from a side.
    for (std::size_t i = 0; i < triangles.size(); i += 23) {
      const auto& [a, b, c] = triangles[i].triangle.corner;
      const Eigen::Vector3d to = (a + b + c) / 3;
      const double size = (b - a).norm() + (c - a).norm();
      const Eigen::Vector3d way = size * Eigen::Vector3d::Random();
      const Sphere ball{to - 3 * way, 0.1 * size + 0x1p-40 * largest};
      const SceneCastResult hit = cast_closest(*bound, ball, {way});
      ASSERT_TRUE(hit.has_value()) << i;
      ASSERT_LE(hit->t_lower, 3.0);
      check(*bound, surface_of(triangles), ball, Motion{way, 8}, 0x1p-43L * largest);
      if (testing::Test::HasFatalFailure()) return;
      std::vector<Eigen::Vector3d> around;  // its center is on the triangle at 3
      for (std::size_t k = 0; k < 3; ++k) {
        const Eigen::Vector3d axis = ball.radius * Eigen::Vector3d::Unit(Eigen::Index(k));
        around.insert(around.end(), {axis, -axis});
      }
      ConvexHull hull;
      hull.points = around;
      hull.position = ball.center;
      const SceneCastResult of_hull = cast_closest(*bound, hull, {way});
      ASSERT_TRUE(of_hull.has_value()) << i;
      ASSERT_LE(of_hull->t_lower, 3.0);
    }
  }
}

// What part of the triangle is touched, and whether it is active, by the corners of the face: the
// pose mirrors half of the instances.
TEST(SceneCastFeatures, AreThoseOfTheFace) {
  cooker::CookOptions options;
  options.active_edges = 5;
  const CookedScene cooked =
      test::cook_scene({test::city(4, 1), test::terrain(6, 1)}, test::random_parts(20, 2, 5, 1, 8),
                       {CodecId::kWide8}, options);
  const Scene scene = require(Scene::bind(cooked.file));
  std::mt19937_64 random(3);
  const auto unit = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
  const auto vector = [&] { return Eigen::Vector3d(unit(), unit(), unit()); };
  int edges = 0, vertices = 0, inactive = 0;
  const auto compare = [&](std::uint32_t instance, const FaceRef& face, std::uint32_t half,
                           Feature feature, std::uint32_t index, const Eigen::Vector3d& point,
                           bool is_active) {
    const Triangle triangle = require(scene.triangle({instance, face}, half));
    const std::uint32_t bits = require(active_edges(scene, {instance, face}, half));
    const Eigen::Vector3d& from = triangle.corner[index];
    const Eigen::Vector3d along = triangle.corner[(index + 1) % 3] - from;
    if (feature == Feature::kVertex) {
      ++vertices;
      ASSERT_LT((point - from).norm(), 1e-9);
      ASSERT_EQ(is_active, (bits & (1u << index | 1u << (index + 2) % 3)) != 0);
    } else if (feature == Feature::kEdge) {
      ++edges;
      ASSERT_LT((point - from).cross(along).norm(), 1e-9);
      ASSERT_EQ(is_active, (bits & 1u << index) != 0);
    } else {
      ASSERT_TRUE(is_active);
    }
    inactive += is_active ? 0 : 1;
  };
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d from = 5 * vector();
    const Motion motion{4 * vector() - from};
    static_cast<void>(require(cast_all(scene, Sphere{from, 0.3}, motion, [&](const auto& hit) {
      compare(hit.instance, hit.face, hit.triangle, hit.feature, hit.feature_index, hit.point,
              hit.is_active);
      return 1e9;
    })));
    static_cast<void>(require(collide(scene, Sphere{from, 0.5}, [&](const auto& contact) {
      compare(contact.instance, contact.face, contact.triangle, contact.feature,
              contact.feature_index, contact.point, contact.is_active);
      return true;
    })));
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(edges, 100);
  EXPECT_GT(vertices, 100);
  EXPECT_GT(inactive, 100);
}

// A face without an area has no sides and no normal, though a pose may give it an area by rounding.
TEST(SceneCastSides, AFaceWithoutAnAreaHasNone) {
  cooker::SourceMesh mesh;
  mesh.name = "line";
  mesh.positions.f32 = {-1, -1, -1, 0, 1, 2, 2, 5, 8};
  mesh.faces = {{{0, 1, 2, cooker::kNoCorner}}};
  std::mt19937_64 random(6);
  const auto unit = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
  for (int i = 0; i < 40; ++i) {
    cooker::SceneParts parts;
    parts.instances.emplace_back().pose = test::random_pose(random, 3, true);
    const CookedScene cooked = test::cook_scene({mesh}, parts);
    const Scene scene = require(Scene::bind(cooked.file));
    const Eigen::Vector3d way = Eigen::Vector3d(unit(), unit(), unit()).normalized();
    const Eigen::Vector3d at = parts.instances[0].pose * Eigen::Vector3d(0, 1, 2);
    const Sphere ball{at - 9 * way, 0.5};
    SceneFaceOptions options;
    options.back_faces = BackFaces::kIgnore;
    const SceneCastResult hit = cast_closest(scene, ball, {way}, options);
    ASSERT_TRUE(hit.has_value()) << i;
    EXPECT_TRUE(hit->face_normal.isZero(0));
    options.back_faces = BackFaces::kOnly;
    const SceneCastResult back = cast_closest(scene, ball, {way}, options);
    EXPECT_TRUE(back.ok() && !back.has_value()) << i;
    int contacts = 0;
    ASSERT_TRUE(collide(scene, Sphere{at, 0.5}, [&](const SceneContact& contact) {
                  EXPECT_TRUE(contact.face_normal.isZero(0));
                  ++contacts;
                  return true;
                }).ok());
    EXPECT_EQ(contacts, 1);
  }
}

TEST(SceneCastErrors, NameTheField) {
  const CookedScene cooked =
      test::cook_scene({test::sphere(6, 8)}, test::random_parts(4, 1, 0, 1, 1));
  const Scene scene = require(Scene::bind(cooked.file));
  const auto refused = [](const auto& result, const char* argument) {
    EXPECT_EQ(result.error().code, Errc::kInvalidQuery);
    EXPECT_EQ(result.error().detail, argument);
  };
  refused(cast_closest(scene, Sphere{{0, 0, 0}, -1}, {{1, 0, 0}}), "radius");
  refused(cast_any(scene, Sphere{{NAN, 0, 0}, 1}, {{1, 0, 0}}), "center");
  refused(cast_closest(scene, Sphere{{0, 0, 0}, 1}, {{INFINITY, 0, 0}}), "direction");
  refused(cast_all(scene, Capsule{{0, 0, 0}, {0, NAN, 0}, 1}, {{1, 0, 0}},
                   [](const SceneCastHit&) { return 1.0; }),
          "end");
  refused(cast_closest(scene, Sphere{{0, 0, 0}, 1}, {{1, 0, 0}, -1}), "t_max");
  refused(cast_any(scene, ConvexHull(), {{1, 0, 0}}), "points");
}

}  // namespace
}  // namespace boxtree
