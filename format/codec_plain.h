// SPDX-License-Identifier: MIT
// Codecs plain-f32 and plain-f16: the paper's optimised BoxTree (chapter 2, table 2.3). Leaves are
// merged into their parents, children are 32-bit numbers, a node is 20 or 16 bytes.
#pragma once

#include <cstdint>
#include <type_traits>

#include "format/binary_node.h"
#include "format/bytes.h"
#include "format/half.h"
#include "format/limits.h"
#include "format/message.h"

namespace boxtree {

/// What a child number of a plain node names.
enum class PlainChild : std::uint32_t {
  kNone = 0,     // a shrink node has one child only; the number is kPlainNoChild
  kLeaf = 1,     // the number is a face
  kSubtree = 2,  // the number is a node
};

inline constexpr std::uint32_t kPlainNoChild = 0xffffffffu;

/// One node. `cutplane`: bits 0-1 the axis, bits 2-3 the kind of the left child, bits 4-5 the kind
/// of the right child, the rest zero. cut[0] is subtracted from the box's high side to give the
/// left child, cut[1] is added to its low side to give the right child; both are in tree space and
/// never negative. The root is node 0. Every child has a larger index than its parent; a first
/// child mostly follows its parent directly.
template <class Cut>
struct PlainNode {
  std::uint32_t cutplane;
  std::uint32_t child[2];
  Cut cut[2];

  [[nodiscard]] std::uint32_t axis() const noexcept { return cutplane & 3u; }
  [[nodiscard]] PlainChild kind(std::size_t side) const noexcept {
    return static_cast<PlainChild>((cutplane >> (2 + 2 * side)) & 3u);
  }
  /// Which of the paper's kinds the node is.
  [[nodiscard]] NodeKind node_kind() const noexcept {
    const bool left_leaf = kind(0) == PlainChild::kLeaf;
    if (kind(1) == PlainChild::kLeaf) {
      return left_leaf ? NodeKind::kTwoLeaves : NodeKind::kRightLeaf;
    }
    return left_leaf ? NodeKind::kLeftLeaf : NodeKind::kNoLeaves;
  }
};
using PlainNodeF32 = PlainNode<float>;
using PlainNodeF16 = PlainNode<std::uint16_t>;
static_assert(sizeof(PlainNodeF32) == 20 && std::is_trivially_copyable_v<PlainNodeF32>);
static_assert(sizeof(PlainNodeF16) == 16 && std::is_trivially_copyable_v<PlainNodeF16>);

[[nodiscard]] constexpr std::uint32_t plain_cutplane(std::uint32_t axis, PlainChild left,
                                                     PlainChild right) noexcept {
  return axis | static_cast<std::uint32_t>(left) << 2 | static_cast<std::uint32_t>(right) << 4;
}

[[nodiscard]] constexpr float cut_value(float cut) noexcept {
  return cut;
}
[[nodiscard]] constexpr double cut_value(double cut) noexcept {
  return cut;
}
[[nodiscard]] constexpr float cut_value(std::uint16_t cut) noexcept {
  return half_to_float(cut);
}

/// Decodes nodes of one tree. NodeRef::first of a subtree is the number of its node.
template <class Cut>
struct PlainCodec {
  using Node = PlainNode<Cut>;
  using Scalar = float;
  using Children = ChildSet<2, float>;
  static constexpr std::uint32_t kDepthLimit = kMaxDepth;

  const std::byte* nodes = nullptr;
  std::uint32_t node_count = 0;

  /// Reads the nodes of a tree out of their section. Error: kSectionSize.
  static Result<PlainCodec> bind(const TreeCounts& counts, Bytes section) {
    const std::uint64_t expected = std::uint64_t{counts.node_count} * sizeof(Node);
    if (section.size() != expected) return section_size_error(section.size(), expected);
    return PlainCodec{section.data(), counts.node_count};
  }

  [[nodiscard]] static NodeRef root() noexcept { return {0, 0}; }

  /// The children of the subtree `ref`, whose decoded box is `box`. kCorrupt when the axis or a
  /// child's kind does not exist, or a child is not a node after its parent. Precondition: `ref`
  /// came from root() or expand().
  [[nodiscard]] NodeState expand(NodeRef ref, const Box<float>& box, Children& out) const noexcept {
    const Node node = load<Node>(nodes, ref.first);
    const std::uint32_t axis = node.axis();
    if (axis > 2 || (node.cutplane >> 6) != 0) return NodeState::kCorrupt;
    out.clear();
    for (std::size_t side = 0; side < 2; ++side) {
      const PlainChild kind = node.kind(side);
      if (kind == PlainChild::kNone) continue;
      const std::uint32_t child = node.child[side];
      const bool is_leaf = kind == PlainChild::kLeaf;
      const bool is_node = kind == PlainChild::kSubtree && child > ref.first && child < node_count;
      if (!is_leaf && !is_node) return NodeState::kCorrupt;
      out.add(child_box(box, axis, side, cut_value(node.cut[side])), {child, is_leaf ? 1u : 0u},
              is_leaf);
    }
    return NodeState::kValid;
  }
};

}  // namespace boxtree
