// SPDX-License-Identifier: MIT
// Refits the tree over moving instances: what programs do for each that moves, each frame.
#include "runtime/scene/moving_tree.h"

namespace boxtree {

void MovingTree::round(std::uint32_t node, std::size_t depth) noexcept {
  Eight& eight = eight_[number_of_eight(node, depth)];
  const Box<double>& box = nodes_[node];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    eight.low[axis][node % 8] = float_below(box.low[axis]);
    eight.high[axis][node % 8] = float_above(box.high[axis]);
  }
}

// Boxes above one that stays as it was stay, too.
void MovingTree::refit(std::uint32_t moving, const Box<double>& box) noexcept {
  std::uint32_t node = leaves_ + place_[moving];
  nodes_[node] = box;
  std::size_t depth = depths_;
  for (std::uint32_t level = 0; node > 1; ++level) {
    if (level % 3 == 0) round(node, --depth);
    node /= 2;
    const Box<double> before = nodes_[node];
    join(node);
    if (nodes_[node] == before) return;
  }
}

void MovingTree::join(std::uint32_t node) noexcept {
  const std::size_t first = 2 * std::size_t{node};
  nodes_[node] = nodes_[first];
  expand(nodes_[node], nodes_[first + 1]);
}

}  // namespace boxtree
