// SPDX-License-Identifier: MIT
// Scenes of any size: poses and queries times a power of two give the same answers to the bit, and
// single instances may be larger or smaller than the rest by any power.
#include <cmath>
#include <random>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "runtime/primitive/predicates.h"
#include "runtime/primitive/vector3.h"
#include "runtime/scene/bound_scene.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/scenes.h"

namespace boxtree {
namespace {

using test::CookedScene;
using test::require;
using test::WorldTriangle;

// All answers to a fixed list of queries, lengths in units of 2^exponent.
struct RangeAnswers {
  std::vector<std::tuple<double, std::uint32_t, std::uint32_t>> rays;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> boxes, spheres;
  std::vector<std::tuple<double, double, double, double, std::uint32_t>> points;
  std::vector<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>> contacts;

  friend bool operator==(const RangeAnswers&, const RangeAnswers&) = default;
};

class SceneRange : public testing::TestWithParam<CodecId> {
 protected:
  // Every `moving`-th instance moves; 1 means all.
  static CookedScene scene_of_size(int exponent, std::uint32_t moving) {
    cooker::SceneParts parts = test::random_parts(12, 2, moving, 1, 11);
    for (cooker::PlacedTree& instance : parts.instances) {
      instance.pose.affine() *= std::ldexp(1.0, exponent);
    }
    return test::cook_scene({test::sphere(5, 6), test::soup(20, 3)}, parts, {GetParam()});
  }

  static RangeAnswers answers(const Scene& scene, int exponent) {
    std::mt19937_64 random(7);
    const auto unit = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
    const double scale = std::ldexp(1.0, exponent);
    const auto point = [&](double spread) -> Eigen::Vector3d {
      const double x = unit(), y = unit();
      return Eigen::Vector3d(x, y, unit()) * spread * scale;
    };
    const auto list = [](std::vector<std::pair<std::uint32_t, std::uint32_t>>& faces) {
      return [&faces](const SceneFace& face) {
        faces.emplace_back(face.instance, face.face.id);
        return true;
      };
    };
    RangeAnswers all;
    for (int i = 0; i < 60; ++i) {
      const auto hit = require(closest_hit(scene, {point(6), point(1) / scale}));
      all.rays.emplace_back(hit ? hit->t / scale : -1, hit ? hit->instance : 0,
                            hit ? hit->face.id : 0);
      const Eigen::Vector3d middle = point(5), half = point(1).cwiseAbs();
      EXPECT_EQ(require(overlap_box(scene, Eigen::AlignedBox3d(middle - half, middle + half),
                                    list(all.boxes))),
                Visit::kComplete);
      EXPECT_EQ(require(overlap_sphere(scene, middle, half[0], list(all.spheres))),
                Visit::kComplete);
      const auto closest = require(closest_point(scene, point(6))).value();
      const Eigen::Vector3d at = closest.point / scale;
      all.points.emplace_back(at[0], at[1], at[2], closest.distance / scale, closest.instance);
    }
    const auto visit = contacts(scene, [&](const ScenePair& pair) {
      all.contacts.emplace_back(pair.first.instance, pair.first.face.id, pair.second.instance,
                                pair.second.face.id);
      return true;
    });
    EXPECT_EQ(require(visit), Visit::kComplete);
    std::sort(all.contacts.begin(), all.contacts.end());
    return all;
  }
};

TEST_P(SceneRange, PowersOfTwoScaleAllAnswers) {
  for (const std::uint32_t moving : {3u, 1u}) {
    const CookedScene cooked = scene_of_size(0, moving);
    const RangeAnswers expected = answers(require(Scene::bind(cooked.file)), 0);
    EXPECT_FALSE(expected.contacts.empty());
    EXPECT_FALSE(expected.spheres.empty());
    for (const int exponent : {-900, -700, -480, -360, -350, -349, -300, -150, -1, 100, 190}) {
      const CookedScene other = scene_of_size(exponent, moving);
      EXPECT_EQ(answers(require(Scene::bind(other.file)), exponent), expected)
          << "2^" << exponent << ", every " << moving << ". moves";
    }
  }
}

// Found by an oracle: the box around such a point, wider by the least number, was taken for its
// extent.
TEST_P(SceneRange, APointAtTheOriginIsFound) {
  test::SourceMesh point;
  point.positions.f32 = {0, 0, 0};
  point.faces = {{{0, 0, 0, cooker::kNoCorner}}};
  for (const bool moves : {false, true}) {
    SCOPED_TRACE(moves);
    cooker::SceneParts parts = test::random_parts(1, 1, 1, 1, 11);
    parts.instances[0].pose = Pose::Identity();
    parts.instances[0].moves = moves;
    const CookedScene cooked = test::cook_scene({point}, parts, {GetParam()});
    const Scene scene = require(Scene::bind(cooked.file));
    EXPECT_EQ(require(closest_point(scene, {0, 0, 0})).value().distance, 0);
    EXPECT_EQ(require(closest_point(scene, {2, 3, 6})).value().distance, 7);
    std::size_t touched = 0;
    const auto count = [&](const SceneFace&) { return ++touched > 0; };
    EXPECT_EQ(require(overlap_sphere(scene, {2, 3, 6}, 7, count)), Visit::kComplete);
    EXPECT_EQ(touched, 1u);
  }
}

// A moving instance of any size among others of size 1: against brute force in the world.
TEST_P(SceneRange, OneInstanceOfAnySize) {
  std::mt19937_64 random(3);
  const auto unit = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
  const CookedScene cooked = scene_of_size(0, 3);
  Scene scene = require(Scene::bind(cooked.file));
  const std::uint32_t instance = BoundScene::of(scene).moving().front().instance;
  std::size_t nearest_there = 0;
  for (int exponent = -400; exponent <= 180; exponent += 20) {
    SCOPED_TRACE(exponent);
    Pose pose = test::random_pose(random, 0, true);
    pose.linear() *= std::ldexp(1.0, exponent);
    if (exponent % 40 == 0) pose.translation() = Eigen::Vector3d{unit(), unit(), unit()};
    ASSERT_TRUE(scene.update(instance, pose).ok());
    const std::vector<WorldTriangle> triangles = test::world_triangles(cooked, scene);
    for (int i = 0; i < 20; ++i) {
      const double spread = i % 2 == 0 ? 3 : 3 * std::ldexp(1.0, exponent);
      const Eigen::Vector3d at =
          Eigen::Vector3d{unit(), unit(), unit()} * spread + pose.translation();
      // In units of 2^exponent where all of it is small, so that squares do not underflow.
      const double up = spread < 1 && pose.translation().isZero(0) ? std::ldexp(1.0, -exponent) : 1;
      double best = std::numeric_limits<double>::infinity();
      for (const WorldTriangle& candidate : triangles) {
        Triangle t = candidate.triangle;
        for (Eigen::Vector3d& c : t.corner) c *= up;
        if (!is_within_range(t.corner[0]) || !is_within_range(t.corner[1])) continue;
        const Eigen::Vector3d closest = closest_point_on_triangle(at * up, t);
        best = std::min(best, std::sqrt(squared_length(closest - at * up)) / up);
      }
      const auto found = require(closest_point(scene, at)).value();
      const double off = 16 * std::numeric_limits<double>::epsilon() *
                         (at.cwiseAbs().maxCoeff() + found.point.cwiseAbs().maxCoeff());
      ASSERT_NEAR(found.distance, best, off);
      nearest_there += found.instance == instance ? 1 : 0;
      // A sphere that just reaches there, or just does not.
      const auto touches = [&](double radius) {
        bool any = false;
        const auto visit = overlap_sphere(scene, at, radius, [&](const SceneFace& face) {
          any = any || (face.instance == found.instance && face.face.id == found.face.id);
          return true;
        });
        EXPECT_EQ(require(visit), Visit::kComplete);
        return any;
      };
      ASSERT_TRUE(touches(found.distance + off));
      ASSERT_TRUE(touches(0x1p1023));  // found by a tester: finite, and said to be not
      if (found.distance > off) {
        ASSERT_FALSE(touches(found.distance - off));
      }
    }
  }
  EXPECT_GT(nearest_there, 100u);
}

// A sheet through the origin, far larger than what single precision holds, and small boxes on it:
// against the predicate for all placed triangles.
TEST_P(SceneRange, SmallBoxesTouchTheLargestInstances) {
  cooker::SourceMesh sheet;
  constexpr int kSide = 9;
  for (int i = 0; i < kSide * kSide; ++i) {
    const auto x = static_cast<float>(i % kSide - kSide / 2), y = static_cast<float>(i / kSide - 3);
    sheet.positions.f32.insert(sheet.positions.f32.end(), {x, y, (x - 2 * y) / 4});
  }
  for (std::uint32_t i = 0; i + kSide + 1 < kSide * kSide; ++i) {
    if (i % kSide == kSide - 1) continue;
    sheet.faces.push_back({{i, i + 1, i + kSide, cooker::kNoCorner}});
    sheet.faces.push_back({{i + 1, i + kSide + 1, i + kSide, cooker::kNoCorner}});
  }
  cooker::SceneParts parts;
  parts.instances.resize(2);
  parts.instances[0].tree = 1;
  parts.instances[1].id = 1;
  parts.instances[1].moves = true;
  const CookedScene cooked = test::cook_scene({sheet, test::soup(20, 3)}, parts, {GetParam()});
  Scene scene = require(Scene::bind(cooked.file));
  const std::uint32_t moving = BoundScene::of(scene).moving().front().instance;
  for (int exponent = 0; exponent <= 180; exponent += 20) {
    SCOPED_TRACE(exponent);
    Pose pose = Pose::Identity();
    pose.linear() *= std::ldexp(1.0, exponent);
    ASSERT_TRUE(scene.update(moving, pose).ok());
    const std::vector<WorldTriangle> triangles = test::world_triangles(cooked, scene);
    std::size_t all = 0;
    for (const double half : {0.0, 0x1p-30, 0.5, 0x1p20}) {
      const Eigen::AlignedBox3d box(Eigen::Vector3d::Constant(-half),
                                    Eigen::Vector3d::Constant(half));
      std::vector<std::pair<std::uint32_t, std::uint32_t>> found, expected;
      for (const WorldTriangle& t : triangles) {
        if (triangle_intersects_box(t.triangle, box.min(), box.max())) {
          expected.emplace_back(t.instance, t.face);
        }
      }
      const auto visit = overlap_box(scene, box, [&found](const SceneFace& face) {
        found.emplace_back(face.instance, face.face.id);
        return true;
      });
      EXPECT_EQ(require(visit), Visit::kComplete);
      std::sort(found.begin(), found.end());
      std::sort(expected.begin(), expected.end());
      EXPECT_EQ(found, expected) << half;
      all += found.size();
    }
    EXPECT_GE(all, 4 * 6u);  // those around the origin
  }
}

INSTANTIATE_TEST_SUITE_P(Codecs, SceneRange,
                         testing::Values(CodecId::kWide8, CodecId::kWide4, CodecId::kPlainF32),
                         test::test_name);

}  // namespace
}  // namespace boxtree
