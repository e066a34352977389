// SPDX-License-Identifier: MIT
// No query allocates: operator new of this program counts.
#include <cmath>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "cooker/cook.h"
#include "tests/support/meshes.h"
#include "tests/support/tree_queries.h"

namespace {
std::size_t allocations = 0;
}

void* operator new(std::size_t size) {
  ++allocations;
  if (void* place = std::malloc(size)) return place;
  throw std::bad_alloc();
}
void operator delete(void* place) noexcept {
  std::free(place);
}
void operator delete(void* place, std::size_t) noexcept {
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

}  // namespace
}  // namespace boxtree
