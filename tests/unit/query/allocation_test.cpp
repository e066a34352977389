// SPDX-License-Identifier: MIT
// No query allocates: operator new of this program counts.
#include <cmath>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "cooker/cook.h"
#include "tests/support/meshes.h"

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
  Pose pose = Pose::Identity();
  pose.translation().x() = 0.5;
  std::size_t visited = 0;
  const auto count = [&visited](const auto&) {
    ++visited;
    return true;
  };
  const std::size_t before = allocations;
  const bool hit = closest_hit(*tree, {{1, 0, 9}, {0, 0, -1}}).has_value();
  const bool any = any_hit(*tree, {{1, 0, 9}, {0, 0, -1}}).has_value();
  const bool near = closest_point(*tree, {3, 1, 2}).has_value();
  const bool box =
      overlap_box(*tree, {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 1, 1)}, count).ok();
  const bool sphere = overlap_sphere(*tree, {1, 0, 0}, 1, count).ok();
  const bool pairs = overlap_pairs(*tree, Pose::Identity(), *tree, pose, count).ok();
  const bool apart = distance(*tree, Pose::Identity(), *tree, pose, {0.1, 0.1}).ok();
  PointOptions options;
  options.node_budget = 10;
  const bool bounded = closest_point(*tree, {3, 1, 2}, options).ok();
  const bool within =
      overlap_within(*tree, Pose::Identity(), *tree, pose, 0.01).ok() &&
      overlap_box_within(*tree, Eigen::AlignedBox3d(Eigen::Vector3d(1, 0, 0)), 0).ok();
  const bool refused = closest_point(*tree, {NAN, 0, 0}).ok();
  EXPECT_EQ(allocations, before);
  EXPECT_TRUE(hit && any && near && box && sphere && pairs && apart && bounded && within &&
              !refused);
  EXPECT_GT(visited, 0u);
}

}  // namespace
}  // namespace boxtree
