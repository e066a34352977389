// SPDX-License-Identifier: MIT
// How far bodies are from a scene, against brute force in extended precision over all placed
// triangles.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "format/codec.h"
#include "runtime/primitive/predicates.h"
#include "runtime/scene/bound_scene.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/scenes.h"
#include "tests/support/shape_reference.h"
#include "tests/support/triangle_reference.h"

namespace boxtree {
namespace {

using test::CookedScene;
using test::LongTriangle;
using test::LongVector;
using test::require;

constexpr double kInfinitelyFar = std::numeric_limits<double>::infinity();

// Of coordinates up to 40 here, and poses that magnify what is rounded.
constexpr long double kRounding = 1e-11L;

// A triangle in the world, whose ball rules out most pairs.
struct Placed {
  explicit Placed(const Triangle& of) : rounded(of), triangle(test::long_triangle(of)) {
    center = (triangle[0] + triangle[1] + triangle[2]) / 3;
    for (const LongVector& c : triangle) radius = std::max(radius, (c - center).norm());
  }
  Triangle rounded;
  LongTriangle triangle;
  LongVector center;
  long double radius = 0;
};

long double distance_of(const std::vector<Placed>& first, const std::vector<Placed>& second) {
  long double least = std::numeric_limits<long double>::infinity();
  for (const Placed& a : first) {
    for (const Placed& b : second) {
      if ((a.center - b.center).norm() - a.radius - b.radius > least) continue;
      least = triangles_intersect(a.rounded, b.rounded)
                  ? 0
                  : std::min(least, test::distance_in_extended_precision(a.triangle, b.triangle));
    }
  }
  return least;
}

std::vector<Placed> placed_triangles(const Tree& tree, const Pose& pose) {
  std::vector<Placed> placed;
  for (Triangle triangle : test::all_triangles(tree)) {
    for (auto& c : triangle.corner) {
      c = test::placed(pose, BoundTree::of(tree).frame().to_object(c));
    }
    placed.emplace_back(triangle);
  }
  return placed;
}

class SceneDistanceTest : public testing::TestWithParam<CodecId> {
 protected:
  static constexpr std::uint32_t kInstances = 30;

  SceneDistanceTest()
      : cooked_(test::cook_scene(
            {test::sphere(8, 12), test::torus(10, 14), test::terrain(6, 1), test::soup(40, 3)},
            test::random_parts(kInstances, 4, 7, 3, 11), {GetParam()})),
        scene_(require(Scene::bind(cooked_.file))),
        body_(test::cook_tree(test::torus(6, 9), GetParam())) {
    place_all();
  }

  // After instances have moved.
  void place_all() {
    world_.assign(kInstances, {});
    for (const test::WorldTriangle& of : test::world_triangles(cooked_, scene_)) {
      world_[of.instance].emplace_back(of.triangle);
    }
  }

  // From the instances that `admits` lets count.
  template <class Admits>
  long double truth(const std::vector<Placed>& body, const Admits& admits) {
    long double least = std::numeric_limits<long double>::infinity();
    for (std::uint32_t i = 0; i < kInstances; ++i) {
      if (scene_.is_enabled(i) && admits(i)) least = std::min(least, distance_of(world_[i], body));
    }
    return least;
  }

  [[nodiscard]] std::uint32_t layer_of(std::uint32_t instance) const {
    return require(scene_.info(instance)).layer;
  }

  // Bounds hold the truth, and the witness is what it says.
  void check(const SceneDistance& found, long double truth, const DistanceOptions& options,
             const std::vector<Placed>& body) {
    EXPECT_LE(found.lower, truth + kRounding);
    if (!found.witness) {
      EXPECT_EQ(found.upper, kInfinitelyFar);
      return;
    }
    EXPECT_GE(found.upper, truth - kRounding);
    EXPECT_LE(found.lower, found.upper);
    if (found.converged) {
      const double allowed = std::max(found.lower * options.relative_error, options.absolute_error);
      EXPECT_LE(found.upper, found.lower + allowed + 1e-11);
    }
    const SceneDistanceWitness& witness = *found.witness;
    const LongVector a = witness.first.cast<long double>(), b = witness.second.cast<long double>();
    EXPECT_NEAR(static_cast<double>((a - b).norm()), found.upper, 1e-11);
    const auto from = [](const LongVector& p, const std::vector<Placed>& surface) {
      const Eigen::Vector3d at = p.cast<double>();
      return distance_of({Placed(Triangle{{at, at, at}})}, surface);
    };
    EXPECT_LE(from(a, triangles_of(witness.faces.first)), kRounding);
    EXPECT_LE(
        from(b, witness.faces.second.instance == kNoInstance ? body
                                                             : triangles_of(witness.faces.second)),
        kRounding);
  }

  std::vector<Placed> triangles_of(const SceneFace& face) {
    return {Placed(require(scene_.triangle(face, 0)))};
  }

  Pose body_pose(double spread) { return test::random_pose(random_, spread, true); }
  double unit() { return std::uniform_real_distribution<double>(0, 1)(random_); }

  std::mt19937_64 random_{5};
  CookedScene cooked_;
  Scene scene_;
  test::CookedTree body_;
  std::vector<std::vector<Placed>> world_;  // of each instance
};

TEST_P(SceneDistanceTest, OfABodyIsThatOfBruteForce) {
  std::size_t apart = 0, touching = 0;
  const std::size_t bodies =
      is_wide(GetParam()) ? 60 : 20;  // what all codecs share takes most of the time
  for (std::size_t i = 0; i < bodies; ++i) {
    if (i % 10 == 9) {  // others are where they were
      for (const BoundScene::Moving& moving : BoundScene::of(scene_).moving()) {
        ASSERT_TRUE(scene_.update(moving.instance, body_pose(4)).ok());
      }
      const std::uint32_t off = static_cast<std::uint32_t>(i % kInstances);
      ASSERT_TRUE(scene_.set_enabled(off, !scene_.is_enabled(off)).ok());
      place_all();
    }
    const Pose pose = body_pose(i % 3 == 0 ? 3 : 30);
    const std::vector<Placed> body = placed_triangles(body_.tree, pose);
    const LayerMask layers = i % 4 == 0 ? 2 : i % 4 == 1 ? 5 : kAllLayers;
    const long double expected =
        truth(body, [&](std::uint32_t n) { return ((layers >> layer_of(n)) & 1) != 0; });
    const SceneDistance found = require(distance(scene_, body_.tree, pose, layers));
    check(found, expected, {}, body);
    EXPECT_TRUE(found.converged);
    ASSERT_TRUE(found.witness.has_value());
    EXPECT_EQ(found.witness->faces.second.instance, kNoInstance);
    EXPECT_NE((layers >> layer_of(found.witness->faces.first.instance)) & 1, 0u);
    (found.upper == 0 ? touching : apart) += 1;

    const double d = static_cast<double>(expected);
    for (const double factor : {0.0, 0.5, 0.999, 1.001, 3.0}) {
      const DistanceOptions within{.max_distance = d * factor};
      const SceneDistance near = require(distance(scene_, body_.tree, pose, layers, within));
      EXPECT_EQ(near.witness.has_value(), d * factor >= d) << factor;
      if (near.witness) {
        EXPECT_NEAR(near.upper, found.upper, 1e-11);
      } else {
        EXPECT_GE(near.lower, d * factor);
      }
      check(near, expected, within, body);
    }
    const DistanceOptions roughly{.relative_error = unit(), .absolute_error = unit() / 10};
    check(require(distance(scene_, body_.tree, pose, layers, roughly)), expected, roughly, body);
    std::uint64_t before = 0;
    for (const std::uint64_t budget : {0u, 1u, 3u, 10u, 100u, 1000u}) {
      const DistanceOptions limited{.node_budget = budget};
      const SceneDistance some = require(distance(scene_, body_.tree, pose, layers, limited));
      check(some, expected, {}, body);
      EXPECT_LE(some.nodes_expanded, budget);
      EXPECT_GE(some.nodes_expanded, before);
      before = some.nodes_expanded;
    }
    if (HasFailure()) FAIL() << "body " << i;
  }
  EXPECT_GT(apart, bodies / 3);
  EXPECT_GT(touching, bodies / 12);
}

TEST_P(SceneDistanceTest, OfAnInstanceIsThatFromWhatItCollidesWith) {
  for (const BoundScene::Moving& moving : BoundScene::of(scene_).moving()) {
    ASSERT_TRUE(scene_.update(moving.instance, body_pose(40)).ok());
  }
  place_all();
  for (std::uint32_t i = 0; i < kInstances; ++i) {
    const long double expected = truth(world_[i], [&](std::uint32_t n) { return n != i; });
    const SceneDistance found = require(distance_of(scene_, i));
    check(found, expected, {}, {});
    ASSERT_TRUE(found.witness.has_value());
    EXPECT_EQ(found.witness->faces.first.instance, i);
    EXPECT_NE(found.witness->faces.second.instance, i);
    if (HasFailure()) FAIL() << "instance " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Codecs, SceneDistanceTest,
                         testing::Values(CodecId::kWide8, CodecId::kWide4, CodecId::kPackedF32),
                         test::test_name);

// Spheres around each other, `count` of them, whose boxes all hold the body: none tells how far
// away it is, so all have to be compared, in several turns.
TEST(SceneDistanceOfShells, ComparesAsManyAsThereAre) {
  constexpr std::uint32_t kShells = 2500, kNearest = 2400;
  cooker::SceneParts parts;
  for (std::uint32_t i = 0; i < kShells; ++i) {
    Pose pose = Pose::Identity();
    pose.linear() *= i == kNearest ? 5 : 10 + i;
    parts.instances.push_back({.id = i, .pose = pose});
  }
  const CookedScene cooked = test::cook_scene({test::sphere(6, 8)}, parts);
  const Scene scene = require(Scene::bind(cooked.file));
  const test::CookedTree body = test::cook_tree(test::sphere(6, 8), CodecId::kWide8);
  const SceneDistance found = require(distance(scene, body.tree, Pose::Identity()));
  ASSERT_TRUE(found.witness.has_value());
  EXPECT_EQ(require(scene.info(found.witness->faces.first.instance)).id, kNearest);
  const Distance alone = require(
      distance(scene.trees()[0], parts.instances[kNearest].pose, body.tree, Pose::Identity()));
  EXPECT_NEAR(found.upper, alone.upper, 1e-12);
}

// More boxes than there is room for are a little nearer than that of the nearest instance, which
// has the first number: their gaps are one float.
TEST(SceneDistanceOfACrowd, MissesNoneWhoseGapIsNearlyThatOfOthers) {
  constexpr std::uint32_t kOthers = 3000;
  // A triangle across its box, and two in opposite sides of the same box.
  cooker::SourceMesh across, facing, speck;
  across.positions.f32 = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  facing.positions.f32 = {0, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0, 1, 1, 0, 1, 0, 1};
  speck.positions.f32 = {0, 0, 0, 0, 1e-9F, 0, 0, 0, 1e-9F};
  for (cooker::SourceMesh* mesh : {&across, &facing, &speck}) {
    for (std::uint32_t i = 0; i < mesh->positions.size(); i += 3) {
      mesh->faces.push_back({{i, i + 1, i + 2, cooker::kNoCorner}});
    }
  }
  cooker::SceneParts parts;
  for (std::uint32_t i = 0; i <= kOthers; ++i) {
    Pose pose = Pose::Identity();
    pose.translation().x() = 10 + (i == 0 ? 1e-7 : 1e-8 + i * 1e-11);
    parts.instances.push_back({.tree = i == 0 ? 1u : 0u, .id = i, .moves = true, .pose = pose});
  }
  const CookedScene cooked = test::cook_scene({across, facing}, parts);
  const Scene scene = require(Scene::bind(cooked.file));
  const test::CookedTree body = test::cook_tree(speck, CodecId::kWide8);
  const SceneDistance found = require(distance(scene, body.tree, Pose::Identity()));
  EXPECT_NEAR(found.upper, 10 + 1e-7, 1e-12);
  ASSERT_TRUE(found.witness.has_value());
  EXPECT_EQ(found.witness->faces.first.instance, 0u);
}

class SceneDistanceErrors : public testing::Test {
 protected:
  SceneDistanceErrors()
      : cooked_(test::cook_scene({test::sphere(4, 6)}, test::random_parts(3, 1, 2, 1, 1))),
        scene_(require(Scene::bind(cooked_.file))),
        body_(test::cook_tree(test::sphere(4, 6), CodecId::kWide8)) {}

  CookedScene cooked_;
  Scene scene_;
  test::CookedTree body_;
};

TEST_F(SceneDistanceErrors, NameWhatIsInvalid) {
  const Pose here = Pose::Identity();
  Pose flat = here;
  flat.linear().setZero();
  EXPECT_EQ(distance(scene_, body_.tree, flat).code(), Errc::kInvalidPose);
  for (const double bad : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
    const auto refused = distance(scene_, body_.tree, here, kAllLayers, {.max_distance = bad});
    EXPECT_EQ(refused.code(), Errc::kInvalidQuery);
    EXPECT_NE(refused.error().detail.find("max_distance"), std::string::npos);
    EXPECT_EQ(distance_of(scene_, 0, {.absolute_error = bad}).code(), Errc::kInvalidQuery);
  }
  EXPECT_EQ(distance_of(scene_, 3).code(), Errc::kInstanceIndex);
}

TEST_F(SceneDistanceErrors, NothingThatCountsIsInfinitelyFar) {
  const Pose here = Pose::Identity();
  const auto is_nothing = [](const Result<SceneDistance>& found, double lower) {
    const SceneDistance& answer = require(found);
    EXPECT_EQ(answer.lower, lower);
    EXPECT_EQ(answer.upper, kInfinitelyFar);
    EXPECT_FALSE(answer.witness.has_value());
    EXPECT_TRUE(answer.converged);
  };
  is_nothing(distance(scene_, body_.tree, here, 2), kInfinitelyFar);
  is_nothing(distance(scene_, body_.tree, here, 2, {.max_distance = 3}), 3);
  ASSERT_TRUE(scene_.set_enabled(1, false).ok());
  is_nothing(distance_of(scene_, 1), kInfinitelyFar);
  for (const std::uint32_t i : {0u, 2u}) ASSERT_TRUE(scene_.set_enabled(i, false).ok());
  is_nothing(distance(scene_, body_.tree, here), kInfinitelyFar);
  const test::CookedTree empty = test::cook_tree(cooker::SourceMesh{}, CodecId::kWide8);
  is_nothing(distance(scene_, empty.tree, here), kInfinitelyFar);
}

}  // namespace
}  // namespace boxtree
