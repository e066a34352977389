// SPDX-License-Identifier: MIT
// The tree over moving instances: every inner box is the union of what is below, always.
#include <random>
#include <set>

#include <gtest/gtest.h>

#include <boxtree/runtime/query/traversal.h>
#include <boxtree/runtime/scene/moving_tree.h>

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
  Box<double> asked;

  [[nodiscard]] bool overlaps(const Box<double>& box) const noexcept {
    bool apart = false;
    for (std::size_t k = 0; k < 3; ++k) {
      apart |= box.low[k] > asked.high[k] || box.high[k] < asked.low[k];
    }
    return !apart;
  }
  [[nodiscard]] bool leaf(NodeRef ref) { return found.insert(tree.moving(ref)).second; }
};

TEST(MovingTree, FindsWhatOverlapsBeforeAndAfterMoving) {
  std::mt19937_64 random(2);
  for (const std::size_t count : {1u, 2u, 3u, 5u, 8u, 33u, 100u}) {
    std::vector<Box<double>> boxes;
    for (std::size_t i = 0; i < count; ++i) boxes.push_back(random_box(random));
    MovingTree tree;
    tree.build(boxes);
    for (int round = 0; round < 200; ++round) {
      All query{tree, boxes, {}, random_box(random)};
      std::set<std::uint32_t> expected;
      for (std::uint32_t i = 0; i < count; ++i) {
        EXPECT_EQ(tree.box(i), boxes[i]);
        if (query.overlaps(boxes[i])) expected.insert(i);
      }
      ASSERT_EQ(traverse_overlap(tree, tree.codec(), query), Errc::kOk);
      // A tree of one leaf answers with it whatever its box is: the root box was tested.
      EXPECT_EQ(query.found, expected) << count;
      const auto moved = static_cast<std::uint32_t>(random() % count);
      boxes[moved] = random_box(random);
      tree.refit(moved, boxes[moved]);
    }
  }
}

TEST(MovingTree, IsEmptyWithoutInstances) {
  const MovingTree tree;
  EXPECT_TRUE(tree.empty());
  EXPECT_EQ(tree.record().root, RootKind::kEmpty);
}

}  // namespace
}  // namespace boxtree
