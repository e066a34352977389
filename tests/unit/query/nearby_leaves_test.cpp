// SPDX-License-Identifier: MIT
// The pair of leaves that the search for a distance begins with.
#include "runtime/query/nearby_leaves.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "runtime/primitive/triangle_distance.h"
#include "runtime/walk/read_leaf.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"

namespace boxtree {
namespace {

using cooker::SourceMesh;

std::vector<Triangle> triangles_in(const BoundTree& tree, NodeRef leaf) {
  TriangleBatch batch;
  EXPECT_EQ(read_leaf(tree, leaf, batch), Errc::kOk);
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i < batch.count; ++i) triangles.push_back(batch.triangle(i));
  return triangles;
}

// In the first tree's space.
double near_leaves_apart(const std::vector<Triangle>& first, const std::vector<Triangle>& second,
                         const RelativePose& pose) {
  double least = std::numeric_limits<double>::infinity();
  for (const Triangle& a : first) {
    for (const Triangle& b : second) {
      least = std::min(least, triangle_distance(a, pose.to_first().apply(b)).upper);
    }
  }
  return least;
}

class NearbyLeavesOf : public testing::TestWithParam<test::Encoding> {};

TEST_P(NearbyLeavesOf, AreAsNearAsAnyOfConvexBodies) {
  const SourceMesh ball = test::sphere(24, 32);
  const test::CookedTree cooked = cook_tree(ball, GetParam());
  const BoundTree& tree = BoundTree::of(cooked.tree);
  std::mt19937_64 random(5);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const double diameter = cooked.tree.bounds().diagonal().norm();
  for (int turn = 0; turn < 20; ++turn) {
    SCOPED_TRACE(turn);
    Pose moved = Pose::Identity();
    moved.linear() = Eigen::Quaterniond(between(-1, 1), between(-1, 1), between(-1, 1), 0.3)
                         .normalized()
                         .toRotationMatrix();
    const Eigen::Vector3d along(between(-1, 1), between(-1, 1), between(-1, 1));
    moved.translation() = between(0.7, 3) * diameter * along.normalized();
    const auto pose = RelativePose::make(tree, Pose::Identity(), tree, moved);
    ASSERT_TRUE(pose.has_value());
    const std::optional<NearbyLeaves> found = nearby_leaves(tree, tree, *pose);
    ASSERT_TRUE(found.has_value());
    const double near = near_leaves_apart(triangles_in(tree, found->first),
                                          triangles_in(tree, found->second), *pose);
    const auto whole = distance(cooked.tree, Pose::Identity(), cooked.tree, moved);
    ASSERT_TRUE(whole.ok());
    const double least = std::ldexp(whole->lower, -tree.scale_exponent());
    EXPECT_GE(near, least);
    EXPECT_LE(near, 1.02 * least);
  }
}

// All faces of a ball are equally near to its middle.
TEST_P(NearbyLeavesOf, AreFoundWhereAllAreEquallyNear) {
  SourceMesh grain = test::sphere(4, 6);
  for (float& coordinate : grain.positions.f32) coordinate *= 1e-3F;
  const test::CookedTree ball = cook_tree(test::sphere(24, 32), GetParam());
  const test::CookedTree inside = cook_tree(grain, GetParam());
  const BoundTree &first = BoundTree::of(ball.tree), &second = BoundTree::of(inside.tree);
  Pose moved = Pose::Identity();
  moved.translation() = ball.tree.bounds().center() - inside.tree.bounds().center();
  const auto pose = RelativePose::make(first, Pose::Identity(), second, moved);
  ASSERT_TRUE(pose.has_value());
  const std::optional<NearbyLeaves> found = nearby_leaves(first, second, *pose);
  ASSERT_TRUE(found.has_value());
  EXPECT_LE(found->first.first + found->first.second, first.counts().faces_in_leaves);
  EXPECT_LE(found->second.first + found->second.second, second.counts().faces_in_leaves);
  EXPECT_GT(found->first.second, 0u);
  EXPECT_GT(found->second.second, 0u);
}

INSTANTIATE_TEST_SUITE_P(Encodings, NearbyLeavesOf, testing::ValuesIn(test::all_encodings()),
                         test::encoding_name);

}  // namespace
}  // namespace boxtree
