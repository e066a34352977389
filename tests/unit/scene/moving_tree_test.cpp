// SPDX-License-Identifier: MIT
// The tree over moving instances: every inner box is the union of what is below, always.
#include "runtime/scene/moving_tree.h"

#include <random>
#include <set>

#include <gtest/gtest.h>

#include "runtime/walk/traversal.h"

namespace boxtree {
namespace {

Box<double> random_box(std::mt19937_64& random) {
  std::uniform_real_distribution<double> place(-10, 10), size(0, 2);
  Box<double> box;
  for (std::size_t k = 0; k < 3; ++k) {
    box.low[k] = place(random);
    box.high[k] = box.low[k] + size(random);
  }
  return box;
}

struct All {
  const MovingTree& tree;
  const std::vector<Box<double>>& boxes;
  std::set<std::uint32_t> found;
  Box<double> region;
  WalkBound& nodes;

  [[nodiscard]] bool overlaps(const Box<double>& box) const noexcept {
    bool apart = false;
    for (std::size_t k = 0; k < 3; ++k) {
      apart |= box.low[k] > region.high[k] || box.high[k] < region.low[k];
    }
    return !apart;
  }
  [[nodiscard]] bool leaf(NodeRef ref) { return found.insert(tree.instance(ref)).second; }
};

TEST(MovingTree, FindsWhatOverlapsBeforeAndAfterMoving) {
  std::mt19937_64 random(2);
  for (const std::size_t count : {1u, 2u, 3u, 5u, 8u, 33u, 100u}) {
    std::vector<Box<double>> boxes;
    for (std::size_t i = 0; i < count; ++i) boxes.push_back(random_box(random));
    MovingTree tree(boxes, nullptr);
    for (int round = 0; round < 200; ++round) {
      WalkBound nodes(tree.node_count());
      All query{tree, boxes, {}, random_box(random), nodes};
      std::set<std::uint32_t> expected;
      Box<double> whole = boxes[0];
      for (std::uint32_t i = 0; i < count; ++i) {
        EXPECT_EQ(tree.box(i), boxes[i]);
        expand(whole, boxes[i]);
        if (query.overlaps(boxes[i])) expected.insert(i);
      }
      EXPECT_EQ(tree.root_box(), whole) << count;
      ASSERT_EQ(traverse_overlap(tree, tree.decoder(), query), Errc::kOk);
      // A tree of one leaf answers with it whatever its box is: the root box was tested.
      EXPECT_EQ(query.found, expected) << count;
      const auto moved = static_cast<std::uint32_t>(random() % count);
      boxes[moved] = random_box(random);
      tree.refit(moved, boxes[moved]);
    }
  }
}

// Two swarms far apart. Boxes are far larger than that on the other axes, each other pair of them:
// places count, not sizes.
TEST(MovingTree, NeighboursInTheTreeAreNeighboursInSpace) {
  std::mt19937_64 random(5);
  for (const std::size_t axis : {0u, 1u, 2u}) {
    std::vector<Box<double>> boxes;
    for (std::size_t i = 0; i < 32; ++i) {
      boxes.push_back(random_box(random));
      for (std::size_t k = 0; k < 3; ++k) {
        const double away = k == axis ? (i % 2 == 0 ? -1000 : 1000) : 0;
        const double size = k != axis && i / 2 % 2 == 0 ? 10000 : 0;
        boxes.back().low[k] += away - size;
        boxes.back().high[k] += away + size;
      }
    }
    MovingTree tree(boxes, nullptr);
    ChildSet<2, double> children;
    ASSERT_EQ(tree.decoder().expand(tree.root_ref(), tree.root_box(), children), NodeState::kValid);
    ASSERT_EQ(children.count, 2u);
    const double apart = 1000 - 20;
    EXPECT_TRUE(children.box(0).high[axis] < -apart && children.box(1).low[axis] > apart) << axis;
  }
}

TEST(MovingTree, IsEmptyWithoutInstances) {
  const MovingTree tree;
  EXPECT_TRUE(tree.empty());
  EXPECT_FALSE(tree.is_leaf());
  EXPECT_EQ(tree.node_count(), 0u);
}

}  // namespace
}  // namespace boxtree
