// SPDX-License-Identifier: MIT
// Scenes of meshes with duplicate faces against brute force over every placed triangle.
#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include "runtime/primitive/predicates.h"
#include "runtime/primitive/vector3.h"
#include "tests/support/coincident.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/scenes.h"

namespace boxtree {
namespace {

using test::require;
using test::WorldTriangle;

class SceneDuplicates : public testing::TestWithParam<CodecId> {
 protected:
  SceneDuplicates()
      : cooked_(test::cook_scene(
            {test::identical_faces(20), test::mixed(test::corner_orders(24), test::torus(6, 5)),
             test::mixed(test::sphere(4, 6), test::sphere(4, 6))},
            test::random_parts(60, 3, 4, 2, 3), {GetParam()})),
        scene_(require(Scene::bind(cooked_.file))),
        triangles_(test::world_triangles(cooked_, scene_)) {}

  Eigen::Vector3d point(double spread = 4) {
    return spread * Eigen::Vector3d{unit(), unit(), unit()};
  }
  double unit() { return std::uniform_real_distribution<double>(-1, 1)(random_); }

  std::mt19937_64 random_{5};
  test::CookedScene cooked_;
  Scene scene_;
  std::vector<WorldTriangle> triangles_;
};

TEST_P(SceneDuplicates, SpheresEqualBruteForce) {
  using Copies = std::multiset<std::pair<std::uint32_t, std::uint32_t>>;
  std::size_t touched = 0;
  for (int i = 0; i < 60; ++i) {
    const Eigen::Vector3d center = point();
    const double radius = 2 + unit();
    Copies expected, found;
    for (const WorldTriangle& t : triangles_) {
      const Eigen::Vector3d near = closest_point_on_triangle(center, t.triangle);
      if (squared_length(near - center) <= radius * radius) expected.emplace(t.instance, t.face);
    }
    const auto visit = [&](const SceneFace& face) {
      found.emplace(face.instance, face.face.id);
      return true;
    };
    ASSERT_TRUE(overlap_sphere(scene_, center, radius, visit).ok());
    ASSERT_EQ(found, expected);
    touched += found.size();
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(radius);
    Copies in_box = std::exchange(found, {});
    ASSERT_TRUE(overlap_box(scene_, {center - half, center + half}, visit).ok());
    for (const auto& face : in_box) ASSERT_EQ(found.count(face), 1u);  // around the sphere
  }
  EXPECT_GT(touched, 1000u);
}

TEST_P(SceneDuplicates, ContactsNameEachPairOfCopiesOnce) {
  std::set<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>> pairs;
  ASSERT_TRUE(contacts(scene_, [&](const ScenePair& pair) {
                EXPECT_TRUE(pairs
                                .emplace(pair.first.instance, pair.first.face.id,
                                         pair.second.instance, pair.second.face.id)
                                .second);
                return true;
              }).ok());
  EXPECT_GT(pairs.size(), 100u);
  // What touches an original touches its copies: faces of tree 0 are all the same.
  const auto is_first_tree = [&](std::uint32_t instance) {
    return require(scene_.info(instance)).tree == 0;
  };
  std::size_t checked = 0;
  for (const auto& [a, face, b, other] : pairs) {
    for (std::uint32_t copy = 0; copy < 20; ++copy) {
      ASSERT_TRUE(!is_first_tree(a) || pairs.contains({a, copy, b, other}));
      ASSERT_TRUE(!is_first_tree(b) || pairs.contains({a, face, b, copy}));
    }
    checked += is_first_tree(a) || is_first_tree(b) ? 1u : 0u;
  }
  EXPECT_GT(checked, 0u);
}

INSTANTIATE_TEST_SUITE_P(Codecs, SceneDuplicates,
                         testing::Values(CodecId::kWide8, CodecId::kWide4, CodecId::kPlainF32,
                                         CodecId::kDedup),
                         test::test_name);

}  // namespace
}  // namespace boxtree
