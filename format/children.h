// SPDX-License-Identifier: MIT
// What every codec decodes: the children of a node and their boxes, given the node and its own box.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "format/box.h"

namespace boxtree {

/// Refers to a subtree or a leaf of one tree. For a leaf: its first face and its number of faces.
/// For a subtree only the codec interprets the two numbers.
struct NodeRef {
  std::uint32_t first;
  std::uint32_t second;

  friend bool operator==(const NodeRef&, const NodeRef&) = default;
};

/// Whether the bytes of a decoded node are valid. This says nothing about the walk that visits the
/// node: a walk continues only through WalkBound::count (runtime/walk/work.h), which takes the
/// state.
enum class [[nodiscard]] NodeState : bool{kCorrupt, kValid};

[[nodiscard]] constexpr NodeState valid_if(bool is_valid) noexcept {
  return is_valid ? NodeState::kValid : NodeState::kCorrupt;
}

/// What the root of a tree is. Numbers are pinned.
enum class RootKind : std::uint8_t { kEmpty = 0, kLeaf = 1, kSubtree = 2 };

/// Numbers of nodes and faces that a tree states; references in its bytes must be below them.
struct TreeCounts {
  std::uint32_t node_count = 0;
  std::uint32_t faces_in_leaves = 0;
};

/// Up to Width children as structure of arrays, so that one vector test serves them all.
/// Entries at and above `count` are unspecified.
template <std::size_t Width, class S>
struct ChildSet {
  static constexpr std::size_t kWidth = Width;
  using Scalar = S;

  std::uint32_t count;
  std::uint32_t leaf_mask;  // bit i: child i is a leaf
  std::array<std::array<S, Width>, 3> low;
  std::array<std::array<S, Width>, 3> high;
  std::array<NodeRef, Width> ref;

  /// Appends a child. Precondition: count < kWidth; leaf_mask has no bit at or above count.
  template <class From>
  void add(const Box<From>& box, NodeRef child, bool is_leaf_child) noexcept {
    const std::uint32_t i = count++;
    for (std::size_t k = 0; k < 3; ++k) {
      low[k][i] = box.low[k];
      high[k][i] = box.high[k];
    }
    leaf_mask |= (is_leaf_child ? 1u : 0u) << i;
    ref[i] = child;
  }
  void clear() noexcept { count = leaf_mask = 0; }

  [[nodiscard]] bool is_leaf(std::uint32_t child) const noexcept {
    return ((leaf_mask >> child) & 1u) != 0;
  }
  [[nodiscard]] Box<S> box(std::uint32_t child) const noexcept {
    return {{low[0][child], low[1][child], low[2][child]},
            {high[0][child], high[1][child], high[2][child]}};
  }
};

}  // namespace boxtree
