// SPDX-License-Identifier: MIT
// What each query takes of the stack, by painting one and looking how far down it was used: what
// the headers state is held for every codec, on deep trees.
#include "tests/support/stack.h"

#include <array>
#include <cstddef>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/scenes.h"
#include "tests/support/tree_queries.h"

namespace boxtree {
namespace {

using test::bytes_used;
using test::is_instrumented;

class Stack : public testing::TestWithParam<CodecId> {
 protected:
  void SetUp() override {
    if (is_instrumented()) GTEST_SKIP() << "frames of sanitizers and of -Og are larger";
  }

  // The thread's own start is not the query's.
  static void expect_at_most(std::size_t kilobytes, const std::string& name,
                             const std::function<void()>& query) {
    const std::size_t idle = bytes_used([] {});
    const std::size_t used = bytes_used(query) - idle;
    EXPECT_LE(used, kilobytes << 10) << name;
    RecordProperty(name, static_cast<int>(used));
  }
};

TEST_P(Stack, OfQueriesOfATreeIsAsDocumented) {
  const test::CookedTree cooked = test::cook_tree(test::terrain(120, 3), GetParam());
  const Tree& tree = cooked.tree;
  test::QuerySet queries;
  queries.point = tree.bounds().center();
  queries.ray = {queries.point + Eigen::Vector3d(0.1, 0.2, 50), {0.001, 0.002, -1}};
  queries.box = tree.bounds();
  queries.radius = 1e3;
  queries.near.translation() = Eigen::Vector3d(0.3, 0.2, 0.05);
  queries.far.translation() = Eigen::Vector3d(0, 0, 40);
  const test::CookedTree other = test::cook_tree(test::terrain(60, 4), CodecId::kPackedF64);
  for (const test::TreeQuery& query : test::tree_queries(queries)) {
    expect_at_most(query.stack_kilobytes, query.name,
                   [&] { EXPECT_EQ(query.run_query(tree, tree, {}).error, Errc::kOk); });
    if (!query.is_of_pairs) continue;
    expect_at_most(query.stack_kilobytes, std::string(query.name) + " of two codecs",
                   [&] { EXPECT_EQ(query.run_query(tree, other.tree, {}).error, Errc::kOk); });
  }
  expect_at_most(64, "overlap_box_within of a point", [&] {
    EXPECT_TRUE(overlap_box_within(tree, Eigen::AlignedBox3d(queries.point), 0).ok());
  });
}

TEST_P(Stack, OfPrefetchIsAsDocumented) {
  const test::CookedTree cooked = test::cook_tree(test::terrain(120, 3), GetParam());
  expect_at_most(64, "prefetch", [&] { EXPECT_GT(cooked.tree.prefetch(100), 0u); });
}

// Found by a newcomer: points far from each other go one by one, and the packet that they were to
// go in took its stack besides, 121 KB of 96.
TEST_P(Stack, OfBatchesThatShareLittleIsAsDocumented) {
  const test::CookedTree cooked = test::cook_tree(test::terrain(60, 3), GetParam());
  const Tree& tree = cooked.tree;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> diagonals(-1, 1);
  const auto anywhere = [&]() -> Eigen::Vector3d {
    const Eigen::Vector3d away(diagonals(random), diagonals(random), diagonals(random));
    return tree.bounds().center() + tree.bounds().diagonal().norm() * away;
  };
  constexpr std::size_t kCount = 1000;
  std::vector<Eigen::Vector3d> points;
  std::vector<Ray> rays;
  std::vector<Sphere> spheres;
  std::vector<Eigen::AlignedBox3d> boxes;
  for (std::size_t i = 0; i < kCount; ++i) {
    points.push_back(anywhere());
    rays.push_back({points[i], anywhere() - points[i]});
    spheres.push_back({points[i], 0.1});
    boxes.emplace_back(points[i]);
    boxes[i].extend(anywhere());
  }
  std::vector<PointResult> nearest(kCount);
  std::vector<RayResult> hits(kCount);
  std::vector<VisitResult> visits(kCount);
  const auto all = [](std::size_t, const FaceRef&) { return true; };
  expect_at_most(96, "closest_points",
                 [&] { EXPECT_TRUE(closest_points(tree, points, nearest).ok()); });
  expect_at_most(96, "closest_hits", [&] { EXPECT_TRUE(closest_hits(tree, rays, hits).ok()); });
  expect_at_most(96, "any_hits", [&] { EXPECT_TRUE(any_hits(tree, rays, hits).ok()); });
  expect_at_most(96, "overlap_spheres",
                 [&] { EXPECT_TRUE(overlap_spheres(tree, spheres, visits, all).ok()); });
  expect_at_most(96, "overlap_boxes",
                 [&] { EXPECT_TRUE(overlap_boxes(tree, boxes, visits, all).ok()); });
}

INSTANTIATE_TEST_SUITE_P(Codecs, Stack, testing::ValuesIn(test::all_codecs()), test::test_name);

TEST(StackOfScenes, IsAsDocumented) {
  if (is_instrumented()) GTEST_SKIP() << "frames of sanitizers and of -Og are larger";
  const test::CookedScene cooked =
      test::cook_scene({test::torus(12, 8), test::city(4, 1)}, test::random_parts(40, 2, 6, 1, 1));
  const Scene scene = test::require(Scene::bind(cooked.file));
  const std::size_t idle = bytes_used([] {});
  const auto all = [](const auto&) { return true; };
  const auto expect = [&](std::size_t kilobytes, const char* name,
                          const std::function<void()>& query) {
    EXPECT_LE(bytes_used(query) - idle, kilobytes << 10) << name;
  };
  expect(64, "closest_hit", [&] {
    EXPECT_TRUE(closest_hit(scene, {{-200, 0.3, 0.2}, {1, 0, 0}}).ok());
  });
  expect(64, "overlap_sphere", [&] {
    EXPECT_TRUE(overlap_sphere(scene, {0, 0, 0}, 1e3, all).ok());
  });
  expect(64, "closest_point", [&] { EXPECT_TRUE(closest_point(scene, {3, 2, 1}).ok()); });
  const Capsule capsule{{-200, 0, 0}, {-200, 1, 0}, 1};
  expect(64, "cast_closest", [&] { EXPECT_TRUE(cast_closest(scene, capsule, {{1, 0, 0}}).ok()); });
  expect(64, "cast_all", [&] {
    EXPECT_TRUE(cast_all(scene, capsule, {{1, 0, 0}}, [](const auto&) { return 1e9; }).ok());
  });
  Frustum all_space;
  for (Frustum::Plane& plane : all_space.planes) plane << 0, 0, 0, 1;
  expect(64, "overlap_frustum", [&] { EXPECT_TRUE(overlap_frustum(scene, all_space, all).ok()); });
  expect(64, "collide", [&] { EXPECT_TRUE(collide(scene, Sphere{{0, 0, 0}, 9}, all).ok()); });
  Pose far = Pose::Identity();
  far.translation().x() = 1e3;
  expect(528, "distance", [&] { EXPECT_TRUE(distance(scene, scene.trees()[0], far).ok()); });
  const std::array<Eigen::Vector3d, 4> points = {{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}}};
  const ConvexHull hull{points, {0, 0, 0}, {1, 0.5, 0.25, 0.125}};
  expect(200, "cast_closest of a hull", [&] {
    EXPECT_TRUE(cast_closest(scene, hull, {{1, 0, 0}}).ok());
  });
  expect(200, "collide of a hull", [&] { EXPECT_TRUE(collide(scene, hull, all).ok()); });
  expect(352, "pair_contacts", [&] { EXPECT_TRUE(pair_contacts(scene, all).ok()); });
  expect(352, "contacts", [&] { EXPECT_TRUE(contacts(scene, all).ok()); });
}

}  // namespace
}  // namespace boxtree
