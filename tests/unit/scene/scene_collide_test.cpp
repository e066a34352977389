// SPDX-License-Identifier: MIT
// Contacts of shapes in scenes against distances in extended precision over all placed triangles.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <set>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "runtime/scene/bound_scene.h"
#include "tests/support/contact_bits.h"
#include "tests/support/meshes.h"
#include "tests/support/reaching_shapes.h"
#include "tests/support/require.h"
#include "tests/support/scenes.h"
#include "tests/support/shape_reference.h"

namespace boxtree {
namespace {

using test::CookedScene;
using test::long_triangle;
using test::LongShape;
using test::LongVector;
using test::require;
using test::WorldTriangle;

using Faces = std::set<std::pair<std::uint32_t, std::uint32_t>>;  // instance, source face

class SceneCollide : public testing::TestWithParam<CodecId> {
 protected:
  SceneCollide()
      : cooked_(test::cook_scene(
            {test::sphere(8, 12), test::torus(10, 14), test::terrain(6, 1), test::soup(40, 3)},
            test::random_parts(40, 4, 7, 3, 11), {GetParam()})),
        scene_(require(Scene::bind(cooked_.file))) {}

  double unit() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  Eigen::Vector3d vector() { return {unit(), unit(), unit()}; }

  template <class Shape>
  void check(const std::vector<WorldTriangle>& triangles, const Shape& shape) {
    const LongShape exact = test::long_shape(shape);
    const long double doubt = 0x1p-42L;
    Faces certain, possible, found;
    for (const WorldTriangle& each : triangles) {
      const test::BoundedTriangle ball(long_triangle(each.triangle));
      if ((ball.center - exact.center).norm() > ball.radius + exact.reach + exact.radius + doubt) {
        continue;
      }
      const long double distance =
          test::distance(exact, LongVector::Zero(), long_triangle(each.triangle));
      if (distance <= exact.radius - doubt || (exact.radius == 0 && distance == 0)) {
        certain.insert({each.instance, each.face});
      }
      if (distance <= exact.radius + doubt) possible.insert({each.instance, each.face});
    }
    ASSERT_EQ(require(collide(scene_, shape,
                              [&](const SceneContact& contact) {
                                found.insert({contact.instance, contact.face.id});
                                compare(exact, contact, doubt);
                                return true;
                              })),
              Visit::kComplete);
    const auto holds = [](const Faces& all, const Faces& some) {
      return std::includes(all.begin(), all.end(), some.begin(), some.end());
    };
    EXPECT_TRUE(holds(found, certain));
    EXPECT_TRUE(holds(possible, found));
    count_ += found.size();
    Faces overlapped;
    std::size_t visits = 0;
    const auto visitor = [&](const SceneFace& face) {
      ++visits;
      return overlapped.insert({face.instance, face.face.id}).second;
    };
    if constexpr (std::is_same_v<Shape, Capsule>) {
      ASSERT_EQ(require(overlap_capsule(scene_, shape, visitor)), Visit::kComplete);
    } else if constexpr (std::is_same_v<Shape, OrientedBox>) {
      ASSERT_EQ(require(overlap_oriented_box(scene_, shape, visitor)), Visit::kComplete);
    } else if constexpr (std::is_same_v<Shape, ConvexHull>) {
      ASSERT_EQ(require(overlap_convex_hull(scene_, shape, visitor)), Visit::kComplete);
    } else {
      return;
    }
    EXPECT_EQ(overlapped, found);
    EXPECT_EQ(visits, found.size());
  }

  // Moved by its depth along the normal the shape has left the triangle, and not much before.
  void compare(const LongShape& exact, const SceneContact& contact, long double doubt) {
    const test::LongTriangle triangle =
        long_triangle(require(scene_.triangle({contact.instance, contact.face}, contact.triangle)));
    const LongVector point = contact.point.cast<long double>();
    EXPECT_LE(test::distance_in_extended_precision({point, point, point}, triangle), doubt);
    EXPECT_NEAR(contact.normal.norm(), 1, 1e-12);
    const long double depth =
        test::depth_along(exact, contact.normal.cast<long double>(), triangle);
    EXPECT_NEAR(static_cast<double>(depth), contact.depth, 1e-11);
  }

  template <class Body>
  void for_each_place(int count, const Body& body) {
    for (const bool moved : {false, true}) {
      for (const BoundScene::Moving& moving : BoundScene::of(scene_).moving()) {
        if (moved) {
          ASSERT_TRUE(scene_.update(moving.instance, test::random_pose(random_, 4, true)).ok());
        }
      }
      const std::vector<WorldTriangle> triangles = test::world_triangles(cooked_, scene_);
      for (int i = 0; i < count; ++i) {
        SCOPED_TRACE(i);
        body(triangles, 5 * vector(), 0.3 * std::pow(8.0, unit()));
        if (HasFatalFailure()) return;
      }
    }
    EXPECT_GT(count_, 100u);
  }

  std::mt19937_64 random_{5};
  CookedScene cooked_;
  Scene scene_;
  std::size_t count_ = 0;
};

TEST_P(SceneCollide, ASphereTouchesWhatItTouches) {
  for_each_place(20, [&](const auto& triangles, const Eigen::Vector3d& at, double radius) {
    check(triangles, Sphere{at, radius});
  });
}

TEST_P(SceneCollide, ACapsuleTouchesWhatItTouches) {
  for_each_place(20, [&](const auto& triangles, const Eigen::Vector3d& at, double radius) {
    check(triangles, Capsule{at, at + vector(), radius});
  });
}

TEST_P(SceneCollide, ABoxTouchesWhatItTouches) {
  for_each_place(10, [&](const auto& triangles, const Eigen::Vector3d& at, double radius) {
    OrientedBox box;
    box.center = at;
    box.half_extents = radius * (vector() + Eigen::Vector3d::Constant(1.1));
    box.rotation.coeffs() << unit(), unit(), unit(), unit();
    check(triangles, box);
  });
}

TEST_P(SceneCollide, AHullTouchesWhatItTouches) {
  for_each_place(10, [&](const auto& triangles, const Eigen::Vector3d& at, double radius) {
    std::vector<Eigen::Vector3d> points(4 + random_() % 5);
    for (Eigen::Vector3d& point : points) point = 1.5 * radius * vector();
    ConvexHull hull;
    hull.points = points;
    hull.position = at;
    if (random_() % 3 != 0) hull.rotation.coeffs() << unit(), unit(), unit(), unit();
    check(triangles, hull);
  });
}

INSTANTIATE_TEST_SUITE_P(Codecs, SceneCollide,
                         testing::Values(CodecId::kPlainF32, CodecId::kWide8, CodecId::kWide4),
                         test::test_name);

// Of turned, sheared and mirrored instances: vectors compute several contacts together, doubles
// one.
TEST(SceneCollideCases, ASphereHasTheSameBitsByVectors) {
  const std::vector<cooker::SourceMesh> meshes = {test::sphere(8, 12), test::torus(10, 14),
                                                  test::slivers(60, 2), test::soup(40, 3)};
  const cooker::SceneParts parts = test::random_parts(40, 4, 7, 3, 11);
  const CookedScene plain = test::cook_scene(meshes, parts, {CodecId::kPlainF32});
  const CookedScene wide = test::cook_scene(meshes, parts, {CodecId::kWide8});
  const auto contacts_of = [](const Scene& scene, const Sphere& sphere) {
    std::vector<std::pair<std::uint32_t, test::ContactBits>> all;
    EXPECT_TRUE(collide(scene, sphere, [&](const SceneContact& contact) {
      all.emplace_back(contact.instance, test::bits_of(contact));
      return true;
    }));
    std::ranges::sort(all);
    return all;
  };
  const Scene first = require(Scene::bind(plain.file)), second = require(Scene::bind(wide.file));
  std::mt19937_64 random(3);
  const auto unit = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
  std::size_t count = 0;
  for (int i = 0; i < 200; ++i) {
    const Sphere sphere{{5 * unit(), 5 * unit(), 5 * unit()}, 0.3 * std::pow(8.0, unit())};
    const auto found = contacts_of(second, sphere);
    ASSERT_EQ(found, contacts_of(first, sphere)) << i;
    count += found.size();
  }
  EXPECT_GT(count, 5'000u);
}

// Shapes that reach a corner, or hardly do, of instances of any size and shape: what vectors see in
// tree space to be inside a shape is inside it in the world.
TEST(SceneCollideCases, OverlapsAreWhereContactsAre) {
  std::mt19937_64 random(9);
  test::ReachingShapes shapes(random);
  cooker::SceneParts parts;
  for (std::uint32_t i = 0; i < 24; ++i) {
    cooker::PlacedTree placed;
    placed.tree = i % 2;
    Eigen::Matrix3d turn =
        Eigen::AngleAxisd(3 * shapes.unit(), shapes.vector().normalized()).toRotationMatrix();
    if (i % 3 == 1) turn *= Eigen::Vector3d(1, 0.3, 4).asDiagonal();
    if (i % 3 == 2) turn(0, 1) += 2;  // sheared
    placed.pose.linear() = std::pow(10.0, shapes.unit()) * turn;
    placed.pose.translation() = 4 * shapes.vector();
    parts.instances.push_back(placed);
  }
  const CookedScene cooked =
      test::cook_scene({test::sphere(16, 24), test::soup(200, 3)}, parts, {CodecId::kWide8});
  const Scene scene = require(Scene::bind(cooked.file));
  const std::vector<WorldTriangle> triangles = test::world_triangles(cooked, scene);
  std::size_t count = 0;
  for (int i = 0; i < 400; ++i) {
    SCOPED_TRACE(i);
    const Triangle& triangle = triangles[random() % triangles.size()].triangle;
    const Eigen::Vector3d at = triangle.corner[0];
    const double more = 1 + (i % 2 == 0 ? 1 : -1) * std::ldexp(1.0, -2 - i % 40);
    const double extent = (triangle.corner[1] - at).norm() * std::ldexp(1.0, i % 5);
    const auto check = [&](const auto& shape, const auto& overlap) {
      Faces overlapped, touched;
      ASSERT_TRUE(overlap(shape, [&](const SceneFace& face) {
        return overlapped.insert({face.instance, face.face.id}).second;
      }));
      ASSERT_TRUE(collide(scene, shape, [&](const SceneContact& contact) {
        touched.insert({contact.instance, contact.face.id});
        return true;
      }));
      ASSERT_EQ(overlapped, touched);
      count += touched.size();
    };
    check(shapes.capsule(at, extent, more),
          [&](const Capsule& shape, const SceneFaceVisitor& visitor) {
            return overlap_capsule(scene, shape, visitor);
          });
    check(shapes.box(at, extent, more),
          [&](const OrientedBox& shape, const SceneFaceVisitor& visitor) {
            return overlap_oriented_box(scene, shape, visitor);
          });
  }
  EXPECT_GT(count, 5'000u);
}

// The center of a sphere on a face of a mirrored instance: the front is where the pose maps it.
TEST(SceneCollideCases, AMirrorKeepsTheFront) {
  cooker::SourceMesh floor;
  floor.name = "floor";
  floor.positions.f32 = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
  floor.faces = {{{0, 1, 2, 3}}};  // up is in front
  for (const double z : {1.0, -1.0}) {
    for (const double x : {1.0, -1.0}) {
      cooker::SceneParts parts;
      cooker::PlacedTree placed;
      placed.pose.linear() = Eigen::Vector3d(x, 1, z).asDiagonal();
      parts.instances.push_back(placed);
      const CookedScene cooked = test::cook_scene({floor}, parts);
      const Scene scene = require(Scene::bind(cooked.file));
      int count = 0;
      ASSERT_TRUE(collide(scene, Sphere{{0.25, 0.5, 0}, 0.125}, [&](const SceneContact& contact) {
        EXPECT_EQ(contact.normal, Eigen::Vector3d(0, 0, z));
        EXPECT_EQ(contact.depth, 0.125);
        return ++count > 0;
      }));
      EXPECT_EQ(count, 1);
    }
  }
}

TEST(SceneCollideErrors, NameTheField) {
  const CookedScene cooked =
      test::cook_scene({test::sphere(6, 8)}, test::random_parts(4, 1, 0, 1, 1));
  const Scene scene = require(Scene::bind(cooked.file));
  const auto none = [](const SceneContact&) { return true; };
  const auto refused = [](const auto& result, const char* argument) {
    EXPECT_EQ(result.error().code, Errc::kInvalidQuery);
    EXPECT_EQ(result.error().detail, argument);
  };
  refused(collide(scene, Sphere{{0, 0, 0}, -1}, none), "radius");
  refused(collide(scene, Sphere{{NAN, 0, 0}, 1}, none), "center");
  OrientedBox box;
  box.half_extents = {1, -1, 1};
  refused(collide(scene, box, none), "half_extents");
  refused(collide(scene, ConvexHull(), none), "points");
  refused(overlap_capsule(scene, Capsule{{0, 0, 0}, {INFINITY, 0, 0}, 1},
                          [](const SceneFace&) { return true; }),
          "end");
}

}  // namespace
}  // namespace boxtree
