// SPDX-License-Identifier: MIT
// Codecs plain-f32 and plain-f16: the paper's optimised BoxTree (chapter 2, table 2.3). Leaves are
// merged into their parents, children are 32-bit numbers, a node is 20 or 16 bytes.
#pragma once

#include <cstdint>
#include <type_traits>

#include <boxtree/format/bytes.h>
#include <boxtree/format/children.h>
#include <boxtree/format/half.h>
#include <boxtree/format/tree_record.h>

namespace boxtree {

/// What a child number of a plain node names.
enum class PlainChild : std::uint32_t {
  kNone = 0,     // a shrink node has one child only; the number is kPlainNoChild
  kLeaf = 1,     // the number is a face
  kSubtree = 2,  // the number is a node
};

inline constexpr std::uint32_t kPlainNoChild = 0xffffffffu;

/// One node. `cutplane`: bits 0-1 the axis, bits 2-3 kind of the left child, bits 4-5 kind of the
/// right child, the rest zero. cut[0] is taken off the box's high side to give the left child,
/// cut[1] is added to its low side to give the right child; both in tree space, never negative.
/// Nodes stand in preorder: a first child directly behind its parent, so that a subtree is a
/// contiguous range of nodes.
template <class Cut>
struct PlainNode {
  std::uint32_t cutplane;
  std::uint32_t child[2];
  Cut cut[2];

  [[nodiscard]] std::uint32_t axis() const noexcept { return cutplane & 3u; }
  [[nodiscard]] PlainChild kind(int side) const noexcept {
    return static_cast<PlainChild>((cutplane >> (2 + 2 * side)) & 3u);
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

[[nodiscard]] constexpr float plain_cut_value(float cut) noexcept {
  return cut;
}
[[nodiscard]] constexpr float plain_cut_value(std::uint16_t cut) noexcept {
  return half_to_float(cut);
}

/// Decodes nodes of one tree. A NodeRef of this codec is the range [first, second) of nodes that
/// the subtree occupies; its root is `first`.
template <class Cut>
struct PlainCodec {
  using Node = PlainNode<Cut>;
  using Scalar = float;
  using Children = ChildSet<2, float>;

  const std::byte* nodes = nullptr;

  /// Reads nodes of `record` out of its section. Error: kSectionSize.
  static Result<PlainCodec> bind(const TreeRecord& record, Bytes section) {
    const std::uint64_t expected = std::uint64_t{record.node_count} * sizeof(Node);
    if (section.size() != expected) return section_size_error(section.size(), expected);
    return PlainCodec{section.data()};
  }

  /// The whole tree: all nodes.
  [[nodiscard]] static NodeRef root(const TreeRecord& record) noexcept {
    return {0, record.node_count};
  }

  /// The children of the subtree `ref`, whose decoded box is `box`. The plane that a cut gives is
  /// the f32 difference or sum, rounded to nearest; encoders choose cuts by this very arithmetic.
  ///
  /// Returns false when the node is corrupt. Whatever the bytes, every child range lies strictly
  /// inside `ref` and the ranges of two children are disjoint: a traversal that starts from
  /// [0, node_count) visits each node at most once, and so ends.
  [[nodiscard]] bool expand(NodeRef ref, const Box<float>& box, Children& out) const noexcept {
    const Node node = load<Node>(nodes, ref.first);
    const std::uint32_t axis = node.axis();
    if (axis > 2 || (node.cutplane >> 6) != 0) return false;

    out.count = 0;
    out.leaf_mask = 0;
    std::uint32_t left_end = ref.second;  // where the left child's range ends
    const PlainChild right_kind = node.kind(1);
    if (right_kind == PlainChild::kSubtree) {
      if (node.child[1] <= ref.first || node.child[1] >= ref.second) return false;
      left_end = node.child[1];
    }
    if (!add_child(node, 0, {ref.first + 1, left_end}, box, out)) return false;
    if (right_kind == PlainChild::kNone) return true;
    return add_child(node, 1, {node.child[1], ref.second}, box, out);
  }

 private:
  [[nodiscard]] static bool add_child(const Node& node, int side, NodeRef range,
                                      const Box<float>& box, Children& out) noexcept {
    const PlainChild kind = node.kind(side);
    if (kind == PlainChild::kNone) return true;
    const std::uint32_t i = out.count++;
    for (std::size_t k = 0; k < 3; ++k) {
      out.low[k][i] = box.low[k];
      out.high[k][i] = box.high[k];
    }
    const std::uint32_t axis = node.axis();
    const float cut = plain_cut_value(node.cut[side]);
    if (side == 0) {
      out.high[axis][i] = box.high[axis] - cut;
    } else {
      out.low[axis][i] = box.low[axis] + cut;
    }
    if (kind == PlainChild::kLeaf) {
      out.leaf_mask |= 1u << i;
      out.ref[i] = {node.child[side], 1};
      return true;
    }
    out.ref[i] = range;
    return kind == PlainChild::kSubtree && range.first == node.child[side] &&
           range.first < range.second;
  }
};

}  // namespace boxtree
