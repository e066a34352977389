// SPDX-License-Identifier: MIT
// What the binary codecs share: the paper's four kinds of node and the arithmetic of a cut.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/children.h"

namespace boxtree {

/// Kinds of node once leaves are merged into their parents (paper section 2.4). A shrink node has
/// one child, a subtree, and counts as kNoLeaves.
enum class NodeKind : std::uint8_t {
  kTwoLeaves = 0,
  kLeftLeaf = 1,   // the left child is a leaf, the right one a subtree
  kRightLeaf = 2,  // the left child is a subtree, the right one a leaf
  kNoLeaves = 3,
};
inline constexpr std::size_t kNodeKinds = 4;

/// Whether the child on that side (0 left, 1 right) of a node of that kind is a leaf.
[[nodiscard]] constexpr bool is_leaf_side(NodeKind kind, std::size_t side) noexcept {
  return kind == NodeKind::kTwoLeaves ||
         kind == (side == 0 ? NodeKind::kLeftLeaf : NodeKind::kRightLeaf);
}

/// A child's box: the parent's with one plane moved inward. The left child's high plane goes down
/// by the cut, the right child's low plane goes up by it; one difference or sum in S, rounded to
/// nearest. Encoders choose cuts with the same function.
template <class S>
[[nodiscard]] constexpr Box<S> child_box(const Box<S>& box, std::size_t axis, std::size_t side,
                                         S cut) noexcept {
  Box<S> child = box;
  if (side == 0) {
    child.high[axis] = box.high[axis] - cut;
  } else {
    child.low[axis] = box.low[axis] + cut;
  }
  return child;
}

}  // namespace boxtree
