// SPDX-License-Identifier: MIT
// Where triangles of a scene touch, against the pairs of faces that do and extended precision.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <set>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "runtime/scene/bound_scene.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/scenes.h"
#include "tests/support/shape_reference.h"

namespace boxtree {
namespace {

using test::CookedScene;
using test::LongTriangle;
using test::LongVector;
using test::require;

using Pairs = std::set<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>>;

// Takes the pairs of faces of a query.
template <class Query>
Pairs pairs_of(const Query& query) {
  Pairs pairs;
  EXPECT_EQ(require(query([&](const ScenePair& pair) {
              pairs.insert({pair.first.instance, pair.first.face.index, pair.second.instance,
                            pair.second.face.index});
              return true;
            })),
            Visit::kComplete);
  return pairs;
}

long double highest(const LongTriangle& triangle, const LongVector& n) {
  return std::max({n.dot(triangle[0]), n.dot(triangle[1]), n.dot(triangle[2])});
}

class ScenePairContacts : public testing::TestWithParam<CodecId> {
 protected:
  ScenePairContacts()
      : cooked_(test::cook_scene(
            {test::sphere(8, 12), test::torus(10, 14), test::terrain(6, 1), test::soup(40, 3)},
            test::random_parts(40, 4, 7, 3, 11), {GetParam()})),
        scene_(require(Scene::bind(cooked_.file))) {}

  // Takes the contacts of a query; `corners(instance, face, half)` has those of a triangle in the
  // world.
  template <class Query, class CornersOf>
  void check(const Pairs& pairs, const Query& query, const CornersOf& corners) {
    Pairs touched;
    std::set<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t,
                        std::uint32_t>>
        each;
    ASSERT_EQ(
        require(query([&](const ScenePairContact& contact) {
          const auto& [a, b] = contact.faces;
          touched.insert({contact.first_instance, a.index, contact.second_instance, b.index});
          EXPECT_TRUE(each.insert({contact.first_instance, a.index, contact.first_triangle,
                                   contact.second_instance, b.index, contact.second_triangle})
                          .second);
          const LongTriangle first = corners(contact.first_instance, a, contact.first_triangle);
          const LongTriangle second = corners(contact.second_instance, b, contact.second_triangle);
          // Of coordinates up to 20 here, and poses that magnify what is rounded.
          const long double allowed = 1e-11L;
          for (const Eigen::Vector3d& point : {contact.start, contact.end, contact.point}) {
            const LongVector p = point.cast<long double>();
            EXPECT_LE(test::distance_in_extended_precision({p, p, p}, first), allowed);
            EXPECT_LE(test::distance_in_extended_precision({p, p, p}, second), allowed);
          }
          EXPECT_NEAR(contact.normal.norm(), 1, 1e-12);
          EXPECT_GE(contact.depth, 0);
          const LongVector normal = contact.normal.cast<long double>();
          const auto depth = [&](const LongVector& n) {
            return highest(first, n) + highest(second, -n);
          };
          EXPECT_LE(depth(normal), contact.depth + allowed);
          for (int i = 0; i < 20; ++i) {
            LongVector other = vector().cast<long double>().normalized();
            if (i % 2 == 0) other = (normal + 0.01L * other).normalized();
            EXPECT_GE(depth(other), contact.depth - allowed);
          }
          return !HasFailure();
        })),
        Visit::kComplete);
    ASSERT_EQ(touched, pairs);
    count_ += each.size();
  }

  LongTriangle in_scene(std::uint32_t instance, const FaceRef& face, std::uint32_t half) {
    return test::long_triangle(require(scene_.triangle({instance, face}, half)));
  }

  double unit() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  Eigen::Vector3d vector() { return {unit(), unit(), unit()}; }

  std::mt19937_64 random_{5};
  CookedScene cooked_;
  Scene scene_;
  std::size_t count_ = 0;
};

TEST_P(ScenePairContacts, OfWhatMovesAreThoseOfItsPairs) {
  const auto corners = [&](std::uint32_t instance, const FaceRef& face, std::uint32_t half) {
    return in_scene(instance, face, half);
  };
  for (const bool moved : {false, true}) {
    for (const BoundScene::Moving& moving : BoundScene::of(scene_).moving()) {
      if (moved) {
        ASSERT_TRUE(scene_.update(moving.instance, test::random_pose(random_, 4, true)).ok());
      }
    }
    check(
        pairs_of([&](ScenePairVisitor visitor) { return contacts(scene_, visitor); }),
        [&](ScenePairContactVisitor visitor) { return pair_contacts(scene_, visitor); }, corners);
    for (const std::uint32_t instance : {0u, 3u, 7u}) {
      check(
          pairs_of(
              [&](ScenePairVisitor visitor) { return contacts_of(scene_, instance, visitor); }),
          [&](ScenePairContactVisitor visitor) {
            return pair_contacts_of(scene_, instance, visitor);
          },
          corners);
    }
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(count_, 1000u);
}

TEST_P(ScenePairContacts, OfABodyAreThoseOfItsPairs) {
  const test::CookedTree body = test::cook_tree(test::torus(8, 8), GetParam());
  for (int i = 0; i < 12; ++i) {
    const Pose pose = test::random_pose(random_, 4, i % 2 == 0);
    const auto corners = [&](std::uint32_t instance, const FaceRef& face, std::uint32_t half) {
      if (instance != kNoInstance) return in_scene(instance, face, half);
      const LongTriangle triangle = test::long_triangle(require(body.tree.triangle(face, half)));
      LongTriangle placed;
      for (std::size_t c = 0; c < 3; ++c) {
        placed[c] = pose.linear().cast<long double>() * triangle[c] +
                    pose.translation().cast<long double>();
      }
      return placed;
    };
    check(
        pairs_of([&](ScenePairVisitor visitor) {
          return overlap_pairs(scene_, body.tree, pose, visitor);
        }),
        [&](ScenePairContactVisitor visitor) {
          return pair_contacts(scene_, body.tree, pose, visitor);
        },
        corners);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(count_, 100u);
}

INSTANTIATE_TEST_SUITE_P(Codecs, ScenePairContacts,
                         testing::Values(CodecId::kPlainF32, CodecId::kWide8, CodecId::kWide4),
                         test::test_name);

// A body that dips into a floor leaves it upwards, in whichever order the two are compared.
TEST(ScenePairContact, TheSecondLeavesTheFirst) {
  cooker::SourceMesh floor, tip;
  floor.name = "floor";
  floor.positions.f32 = {-4, -4, 0, 4, -4, 0, 0, 4, 0};
  floor.faces = {{{0, 1, 2, cooker::kNoCorner}}};
  tip.name = "tip";
  tip.positions.f32 = {0, 0, -0.25, 1, 0, 1, -1, 0, 1};
  tip.faces = {{{0, 1, 2, cooker::kNoCorner}}};
  for (const double turned : {0.0, 0.4}) {  // the pose of the body magnifies more, or less
    for (const double of_floor : {0.0, 0.4}) {
      const auto about_z = [](double angle) {
        return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
      };
      cooker::SceneParts parts;
      cooker::PlacedTree placed;
      placed.pose.linear() = about_z(of_floor);
      parts.instances.push_back(placed);
      const CookedScene cooked = test::cook_scene({floor}, parts);
      const Scene scene = require(Scene::bind(cooked.file));
      const test::CookedTree body = test::cook_tree(tip, CodecId::kWide8);
      Pose pose = Pose::Identity();
      pose.linear() = about_z(turned);
      int count = 0;
      ASSERT_TRUE(pair_contacts(scene, body.tree, pose, [&](const ScenePairContact& contact) {
        EXPECT_EQ(contact.first_instance, 0u);
        EXPECT_EQ(contact.second_instance, kNoInstance);
        EXPECT_NEAR((contact.normal - Eigen::Vector3d::UnitZ()).norm(), 0, 1e-12);
        EXPECT_NEAR(contact.depth, 0.25, 1e-12);
        EXPECT_NEAR(contact.point.norm(), 0, 1e-12);
        return ++count > 0;
      }));
      EXPECT_EQ(count, 1);
    }
  }
}

TEST(ScenePairContact, ErrorsAndStopping) {
  const CookedScene cooked =
      test::cook_scene({test::sphere(6, 8)}, test::random_parts(9, 1, 1, 1, 1));
  const Scene scene = require(Scene::bind(cooked.file));
  int count = 0;
  const auto one = [&](const ScenePairContact&) { return ++count < 1; };
  EXPECT_EQ(pair_contacts_of(scene, 9, one).code(), Errc::kInstanceIndex);
  Pose flat = Pose::Identity();
  flat.linear().setZero();
  EXPECT_EQ(pair_contacts(scene, scene.trees()[0], flat, one).code(), Errc::kInvalidPose);
  EXPECT_EQ(count, 0);
  EXPECT_EQ(require(pair_contacts(scene, one)), Visit::kStopped);
  EXPECT_EQ(count, 1);
  EXPECT_EQ(pair_contacts(scene, one, {.nodes = 1}).code(), Errc::kWorkLimit);
}

}  // namespace
}  // namespace boxtree
