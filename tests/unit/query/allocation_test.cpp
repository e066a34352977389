// SPDX-License-Identifier: MIT
// No query allocates: operator new of this program counts.
#include <array>
#include <cmath>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "cooker/cook.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/scenes.h"
#include "tests/support/tree_queries.h"

namespace {
std::size_t allocations = 0;
}

// Not inlined: where g++ does so with one of a pair, it takes the other for a mismatch.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* place = std::malloc(size)) return place;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* place) noexcept {
  std::free(place);
}
[[gnu::noinline]] void operator delete(void* place, std::size_t) noexcept {
  std::free(place);
}

namespace boxtree {
namespace {

TEST(Allocation, QueriesNeverAllocate) {
  Result<cooker::CookedTree> cooked = cooker::cook_mesh(test::torus(20, 12), {});
  const std::vector<std::byte> bytes = cooker::serialize(std::span(&cooked->tree, 1));
  const Result<File> file = File::open(bytes);
  const Result<Tree> tree = Tree::bind(*file);
  test::QuerySet queries;
  queries.ray = {{1, 0, 9}, {0, 0, -1}};
  queries.box = {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 1, 1)};
  queries.point = {1, 0, 0};
  queries.near.translation().x() = 0.5;
  queries.far.translation().z() = 5;
  for (const test::TreeQuery& query : test::tree_queries(queries)) {
    const std::size_t before = allocations;
    const test::Outcome outcome = query.run_query(*tree, *tree, {});
    EXPECT_EQ(allocations, before) << query.name;
    EXPECT_EQ(outcome.error, Errc::kOk) << query.name;
    EXPECT_NE(outcome.answer, -1) << query.name << " found nothing";
  }
  const std::size_t before = allocations;
  EXPECT_GT(tree->prefetch(100), 0u);
  const bool refused =
      closest_point(*tree, {NAN, 0, 0}).error().detail == "point" &&
      closest_hit(*tree, {{0, 0, 0}, {0, 0, 0}}).error().detail == "direction" &&
      cast_any(*tree, Sphere{{0, 0, 0}, -1}, Motion()).error().detail == "radius" &&
      closest_point(*tree, {0, 0, 0}, PointOptions{-1}).error().detail == "relative_error" &&
      distance(*tree, Pose::Identity(), *tree, Pose::Identity(), DistanceOptions{0, -1})
              .error()
              .detail == "absolute_error";
  EXPECT_EQ(allocations, before);
  EXPECT_TRUE(refused);
}

TEST(Allocation, QueriesOfScenesNeverAllocate) {
  const test::CookedScene cooked =
      test::cook_scene({test::torus(12, 8), test::city(4, 1)}, test::random_parts(40, 2, 6, 1, 1));
  const Scene scene = test::require(Scene::bind(cooked.file));
  const Ray ray{{-9, 0.3, 0.2}, {1, 0, 0}};
  const Motion motion{{1, 0, 0}};
  const Sphere sphere{{-9, 0.3, 0.2}, 1};
  const Capsule capsule{{-9, 0, 0}, {-9, 1, 0}, 1};
  OrientedBox box;
  box.half_extents = {1, 2, 3};
  const std::array<Eigen::Vector3d, 4> points = {{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}}};
  const ConvexHull hull{points, {0, 0, 0}, {1, 0, 0, 0}};
  Frustum everything;
  for (Frustum::Plane& plane : everything.planes) plane << 0, 0, 0, 1;
  SceneFaceOptions options;
  const auto every_face = [](const SceneFace&) { return true; };
  const auto every_instance = [](std::uint32_t) { return true; };
  options.filter = SceneFaceFilter(every_face);
  options.instance_filter = InstanceFilter(every_instance);
  std::array<SceneRayHit, 4> hits;
  const auto all = [](const auto&) { return true; };
  const auto to_the_end = [](const auto&) { return 1e9; };
  const std::size_t before = allocations;
  const bool answered =
      closest_hit(scene, ray) && any_hit(scene, ray) && closest_hit(scene, ray, options) &&
      all_hits(scene, ray, to_the_end, options) && nearest_hits(scene, ray, hits, options) &&
      cast_closest(scene, sphere, motion, options) && cast_any(scene, capsule, motion) &&
      cast_all(scene, box, motion, to_the_end) && collide(scene, sphere, all) &&
      collide(scene, box, all) && overlap_capsule(scene, capsule, all) &&
      overlap_oriented_box(scene, box, all) && cast_closest(scene, hull, motion) &&
      overlap_frustum(scene, everything, all) && instances_in_frustum(scene, everything, all) &&
      collide(scene, hull, all) && overlap_convex_hull(scene, hull, all) &&
      overlap_sphere(scene, {0, 0, 0}, 9, all) &&
      overlap_box(scene, {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 1, 1)}, all) &&
      closest_point(scene, {3, 2, 1}) && contacts(scene, all) && contacts_of(scene, 0, all) &&
      pair_contacts(scene, all) && pair_contacts_of(scene, 0, all) && distance_of(scene, 0) &&
      distance(scene, scene.trees()[0], Pose::Identity());
  EXPECT_EQ(allocations, before);
  EXPECT_TRUE(answered);
}

}  // namespace
}  // namespace boxtree
