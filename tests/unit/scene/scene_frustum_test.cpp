// SPDX-License-Identifier: MIT
// Frustums in scenes against every placed triangle cut by six planes in extended precision.
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "runtime/scene/bound_scene.h"
#include "tests/support/frustum_reference.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/scenes.h"

namespace boxtree {
namespace {

using test::CookedScene;
using test::require;
using test::WorldTriangle;

using Faces = std::set<std::pair<std::uint32_t, std::uint32_t>>;  // instance, source face

std::set<std::uint32_t> instances(const Scene& scene, const Frustum& frustum,
                                  LayerMask layers = kAllLayers) {
  std::set<std::uint32_t> found;
  EXPECT_EQ(require(instances_in_frustum(
                scene, frustum,
                [&](std::uint32_t instance) {
                  EXPECT_TRUE(found.insert(instance).second);
                  return true;
                },
                layers)),
            Visit::kComplete);
  return found;
}

Faces faces(const Scene& scene, const Frustum& frustum) {
  Faces found;
  EXPECT_EQ(
      require(overlap_frustum(scene, frustum,
                              [&](const SceneFace& face) {
                                EXPECT_TRUE(found.insert({face.instance, face.face.id}).second);
                                return true;
                              })),
      Visit::kComplete);
  return found;
}

// Against triangles of coordinates up to `size`.
std::size_t check(const Scene& scene, const std::vector<WorldTriangle>& triangles,
                  const Frustum& frustum, long double size) {
  const Faces found = faces(scene, frustum);
  const std::set<std::uint32_t> held = instances(scene, frustum);
  Faces may;
  for (const WorldTriangle& each : triangles) {
    const std::pair name{each.instance, each.face};
    const test::LongTriangle exact = test::long_triangle(each.triangle);
    if (test::touches(frustum, exact, size, 0)) {
      EXPECT_TRUE(found.contains(name)) << each.instance << " " << each.face;
    }
    if (test::touches(frustum, exact, size, 0x1p-46L)) may.insert(name);
  }
  for (const auto& name : found) {
    EXPECT_TRUE(may.contains(name)) << name.first << " " << name.second;
    EXPECT_TRUE(held.contains(name.first)) << name.first;
  }
  return found.size();
}

class SceneFrustums : public testing::TestWithParam<CodecId> {
 protected:
  SceneFrustums()
      : cooked_(test::cook_scene(
            {test::sphere(8, 12), test::torus(10, 14), test::terrain(6, 1), test::soup(40, 3)},
            test::random_parts(40, 4, 7, 3, 11), {GetParam()})),
        scene_(require(Scene::bind(cooked_.file))) {}

  double unit() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  Eigen::Vector3d vector() { return {unit(), unit(), unit()}; }

  std::mt19937_64 random_{5};
  CookedScene cooked_;
  Scene scene_;
};

TEST_P(SceneFrustums, HaveTheFacesOfExtendedPrecision) {
  std::size_t found = 0;
  for (const bool moved : {false, true}) {
    for (const BoundScene::Moving& moving : BoundScene::of(scene_).moving()) {
      if (moved) {
        ASSERT_TRUE(scene_.update(moving.instance, test::random_pose(random_, 4, true)).ok());
      }
    }
    const std::vector<WorldTriangle> triangles = test::world_triangles(cooked_, scene_);
    const long double size = test::largest_coordinate(triangles);
    for (int i = 0; i < 60; ++i) {
      SCOPED_TRACE(i);
      if (i % 3 != 0) {
        const Frustum::ViewProjection matrix = test::view_projection(
            7 * vector(), 3 * vector(), 0.2 + 0.5 * std::abs(unit()), 0.1, 8 + 7 * unit());
        found += check(scene_, triangles, Frustum::of(matrix), size);
        continue;
      }
      Frustum frustum;
      for (Frustum::Plane& plane : frustum.planes) {
        const Eigen::Vector3d normal = vector();
        plane << normal, 2 * normal.norm();
      }
      // A plane that goes through a corner of a triangle.
      const Eigen::Vector3d corner = triangles[random_() % triangles.size()].triangle.corner[1];
      frustum.planes[2][3] = -frustum.planes[2].head<3>().dot(corner);
      found += check(scene_, triangles, frustum, size);
    }
  }
  EXPECT_GT(found, 5000u);
}

INSTANTIATE_TEST_SUITE_P(Codecs, SceneFrustums,
                         testing::Values(CodecId::kPlainF32, CodecId::kPackedF16, CodecId::kWide8,
                                         CodecId::kWide4),
                         test::test_name);

TEST(SceneFrustum, PlacementsOfEveryKind) {
  for (const Pose& pose : test::extreme_poses()) {
    SCOPED_TRACE(testing::Message() << pose.matrix());
    cooker::SceneParts parts;
    parts.instances.emplace_back().pose = pose;
    const CookedScene cooked = test::cook_scene({test::sphere(6, 8)}, parts);
    const Scene scene = require(Scene::bind(cooked.file));
    const std::vector<WorldTriangle> triangles = test::world_triangles(cooked, scene);
    const long double size = test::largest_coordinate(triangles);
    for (std::size_t i = 0; i < triangles.size(); i += 7) {
      const Eigen::Vector3d at = triangles[i].triangle.corner[0];
      Frustum frustum;  // with a tip at that corner
      for (Frustum::Plane& plane : frustum.planes) {
        const Eigen::Vector3d normal = Eigen::Vector3d(2, 1, -3) + 2 * Eigen::Vector3d::Random();
        plane << normal, -normal.dot(at);
      }
      check(scene, triangles, frustum, size);
      if (testing::Test::HasFailure()) return;
    }
  }
}

TEST(SceneFrustum, LayersAndStopping) {
  cooker::SceneParts parts = test::random_parts(30, 2, 3, 3, 4);
  parts.layers[1].queries = kRayQueries;
  const CookedScene cooked = test::cook_scene({test::sphere(6, 8), test::torus(6, 8)}, parts);
  Scene scene = require(Scene::bind(cooked.file));
  Frustum all;
  for (Frustum::Plane& plane : all.planes) plane << 0, 0, 0, 1;
  std::set<std::uint32_t> answering, of_layer_2;
  for (std::uint32_t i = 0; i < scene.instance_count(); ++i) {
    const std::uint32_t layer = require(scene.info(i)).layer;
    if (layer != 1) answering.insert(i);
    if (layer == 2) of_layer_2.insert(i);
  }
  EXPECT_EQ(instances(scene, all), answering);
  EXPECT_EQ(instances(scene, all, 0b100), of_layer_2);
  ASSERT_TRUE(scene.set_enabled(*answering.begin(), false).ok());
  answering.erase(answering.begin());
  EXPECT_EQ(instances(scene, all), answering);
  int visits = 0;
  EXPECT_EQ(require(instances_in_frustum(scene, all, [&](std::uint32_t) { return ++visits < 3; })),
            Visit::kStopped);
  EXPECT_EQ(visits, 3);
  EXPECT_EQ(require(overlap_frustum(scene, all, [](const SceneFace&) { return false; })),
            Visit::kStopped);
  all.planes[4] << 0, 0, 0, -1;
  EXPECT_TRUE(instances(scene, all).empty());
  EXPECT_TRUE(faces(scene, all).empty());
}

// Culling looks at the bounds as the pose turns them, not at a box along the axes around them.
TEST(SceneFrustum, InstancesByTheirTurnedBounds) {
  cooker::SourceMesh pole;
  pole.name = "pole";
  pole.positions.f32 = {-8, 0, 0, 8, 0, 0, 8, 0.5, 0, -8, 0.5, 0};
  pole.faces = {{{0, 1, 2, 3}}};
  cooker::SceneParts parts;
  cooker::PlacedTree placed;
  placed.pose.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  parts.instances.push_back(placed);
  const CookedScene cooked = test::cook_scene({pole}, parts);
  const Scene scene = require(Scene::bind(cooked.file));
  Frustum frustum;
  for (Frustum::Plane& plane : frustum.planes) plane << 0, 0, 0, 1;
  frustum.planes[0] << 1, -1, 0, -4;  // below the diagonal
  EXPECT_TRUE(instances(scene, frustum).empty());
  frustum.planes[0] << 1, -1, 0, 0;
  EXPECT_EQ(instances(scene, frustum).size(), 1u);
}

TEST(SceneFrustum, OfNumbersThatAreNotFiniteIsAnError) {
  const CookedScene cooked =
      test::cook_scene({test::sphere(6, 8)}, test::random_parts(4, 1, 0, 1, 1));
  const Scene scene = require(Scene::bind(cooked.file));
  Frustum frustum;
  for (Frustum::Plane& plane : frustum.planes) plane << 0, 0, 1, 1;
  frustum.planes[2][3] = INFINITY;
  EXPECT_EQ(overlap_frustum(scene, frustum, [](const SceneFace&) { return true; }).error().detail,
            "planes");
  frustum.planes[2] << NAN, 0, 0, 1;
  EXPECT_EQ(instances_in_frustum(scene, frustum, [](std::uint32_t) { return true; }).error().detail,
            "planes");
}

}  // namespace
}  // namespace boxtree
