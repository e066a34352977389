// SPDX-License-Identifier: MIT
// Codecs wide8 and wide4: eight children per node, their planes in 8 or 4 bits relative to the
// decoded box of the node. Leaves hold eight faces in tree order, so a leaf's number gives its
// faces and no leaf is stored. The child nodes of a node have consecutive numbers, and so do its
// leaves.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "format/bytes.h"
#include "format/children.h"
#include "format/limits.h"
#include "format/message.h"

namespace boxtree {

inline constexpr std::size_t kWideChildren = 8;

/// wide8: one cache line. Children 0 to child_count - 1 exist; child i is a node if bit i of
/// inner_mask is set, else a leaf. In the order of the children, nodes are numbered from first_node
/// and leaves from first_leaf; leaf n holds faces 8n to 8n + 7, or up to the last face.
struct Wide8Node {
  static constexpr std::uint32_t kLargestCode = 255;

  std::array<std::array<std::uint8_t, kWideChildren>, 3> low;   // [axis][child]
  std::array<std::array<std::uint8_t, kWideChildren>, 3> high;  // [axis][child]
  std::uint32_t first_node;
  std::uint32_t first_leaf;
  std::uint8_t inner_mask;
  std::uint8_t child_count;              // 1..8
  std::array<std::uint8_t, 6> reserved;  // zero

  [[nodiscard]] std::uint32_t low_code(std::size_t axis, std::size_t child) const noexcept {
    return low[axis][child];
  }
  [[nodiscard]] std::uint32_t high_code(std::size_t axis, std::size_t child) const noexcept {
    return high[axis][child];
  }
  /// Distance of a plane from the side of the box, in steps.
  [[nodiscard]] static constexpr float steps(std::uint32_t code) noexcept {
    return static_cast<float>(code);
  }
  /// A code of at least this many steps. For writers.
  [[nodiscard]] static std::uint32_t code_above(float steps) noexcept {
    return static_cast<std::uint32_t>(steps) + 1;
  }
  static constexpr float kStepsOfExtent = 255;
};
static_assert(sizeof(Wide8Node) == 64 && std::is_trivially_copyable_v<Wide8Node>);

/// wide4: the same in half a cache line. Steps grow from code to code, because most planes are near
/// the side of the box that they are counted from, and end at 0.85 of its extent, because few
/// planes lie beyond. Of all c * (c + a) / n these constants gave the smallest boxes on scanned,
/// CAD and generated meshes.
struct Wide4Node {
  static constexpr std::uint32_t kLargestCode = 15;
  static constexpr std::uint32_t kFirstSteps = 24;  // `a` above

  std::array<std::uint32_t, 3> low;   // [axis], child i in bits 4i to 4i + 3
  std::array<std::uint32_t, 3> high;  // likewise
  // Bits 0-25 first node, 26-52 first leaf, 53-60 inner mask, 61-63 children less one.
  std::uint64_t links;

  [[nodiscard]] std::uint32_t low_code(std::size_t axis, std::size_t child) const noexcept {
    return (low[axis] >> (4 * child)) & 15u;
  }
  [[nodiscard]] std::uint32_t high_code(std::size_t axis, std::size_t child) const noexcept {
    return (high[axis] >> (4 * child)) & 15u;
  }
  [[nodiscard]] static constexpr float steps(std::uint32_t code) noexcept {
    return static_cast<float>(code * (code + kFirstSteps));
  }
  /// A code of at least this many steps. For writers.
  [[nodiscard]] static std::uint32_t code_above(float steps) noexcept {
    static_assert(kFirstSteps % 2 == 0);
    constexpr std::uint32_t kHalfSteps = kFirstSteps / 2;
    constexpr auto kHalf = static_cast<float>(kHalfSteps);
    return static_cast<std::uint32_t>(std::sqrt(steps + kHalf * kHalf) - kHalf) + 1;
  }
  static constexpr float kStepsOfExtent = 688;
};
static_assert(sizeof(Wide4Node) == 32 && std::is_trivially_copyable_v<Wide4Node>);

/// The links of a node to its children, in any layout.
struct WideLinks {
  std::uint32_t first_node;
  std::uint32_t first_leaf;
  std::uint32_t inner_mask;
  std::uint32_t child_count;
};

/// The most nodes and leaves that the layout of wide4 can number.
inline constexpr std::uint32_t kMaxWide4Nodes = 1u << 26;
inline constexpr std::uint32_t kMaxWide4Leaves = 1u << 27;

[[nodiscard]] inline WideLinks links_of(const Wide8Node& node) noexcept {
  return {node.first_node, node.first_leaf, node.inner_mask, node.child_count};
}
/// Decodes Wide4Node::links.
[[nodiscard]] inline WideLinks links_of_word(std::uint64_t links) noexcept {
  return {static_cast<std::uint32_t>(links) & (kMaxWide4Nodes - 1),
          static_cast<std::uint32_t>(links >> 26) & (kMaxWide4Leaves - 1),
          static_cast<std::uint32_t>(links >> 53) & 0xffu,
          static_cast<std::uint32_t>(links >> 61) + 1};
}
[[nodiscard]] inline WideLinks links_of(const Wide4Node& node) noexcept {
  return links_of_word(node.links);
}

/// Length of a step on one axis of a box: fl(fl(high - low) * fl(1 / steps of the extent)).
template <class Node>
[[nodiscard]] constexpr float wide_step(float low, float high) noexcept {
  return (high - low) * (1 / Node::kStepsOfExtent);
}

/// A plane counted from the low side, and one counted from the high side: one product and one sum,
/// each rounded to nearest. Encoders choose codes with the same functions.
template <class Node>
[[nodiscard]] constexpr float wide_low_plane(float low, float step, std::uint32_t code) noexcept {
  return low + Node::steps(code) * step;
}
template <class Node>
[[nodiscard]] constexpr float wide_high_plane(float high, float step, std::uint32_t code) noexcept {
  return high - Node::steps(code) * step;
}

/// Decodes nodes of one tree. NodeRef::first of a subtree is the number of its node; the root is
/// node 0, and children have larger indices than their parents.
template <class NodeType>
struct WideCodec {
  using Node = NodeType;
  using Scalar = float;
  using Children = ChildSet<kWideChildren, float>;
  static constexpr std::uint32_t kDepthLimit = kMaxWideDepth;

  const std::byte* nodes = nullptr;
  std::uint32_t node_count = 0;
  std::uint32_t face_count = 0;  // faces in leaves

  /// Reads the nodes of a tree out of their section. Error: kSectionSize.
  static Result<WideCodec> bind(const TreeCounts& counts, Bytes section) {
    const std::uint64_t expected = std::uint64_t{counts.node_count} * sizeof(Node);
    if (section.size() != expected) return section_size_error(section.size(), expected);
    return WideCodec{section.data(), counts.node_count, counts.faces_in_leaves};
  }

  [[nodiscard]] static NodeRef root() noexcept { return {0, 0}; }

  /// The children of the subtree `ref`, whose decoded box is `box`. kCorrupt when the node has no
  /// children, or a child is not a node after its parent or a leaf with faces. Precondition: `ref`
  /// came from root() or expand().
  [[nodiscard]] NodeState expand(NodeRef ref, const Box<float>& box, Children& out) const noexcept {
    const Node node = load<Node>(nodes, ref.first);
    const WideLinks links = links_of(node);
    const std::uint32_t count = links.child_count;
    if (count - 1 >= kWideChildren || (links.inner_mask >> count) != 0) return NodeState::kCorrupt;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float step = wide_step<Node>(box.low[axis], box.high[axis]);
      for (std::size_t i = 0; i < kWideChildren; ++i) {
        out.low[axis][i] = wide_low_plane<Node>(box.low[axis], step, node.low_code(axis, i));
        out.high[axis][i] = wide_high_plane<Node>(box.high[axis], step, node.high_code(axis, i));
      }
    }
    out.count = count;
    out.leaf_mask = ~links.inner_mask & ((1u << count) - 1);
    std::uint32_t next_node = links.first_node;
    std::uint64_t next_face = std::uint64_t{links.first_leaf} * kLeafFaces;
    for (std::uint32_t i = 0; i < count; ++i) {
      if (out.is_leaf(i)) {
        if (next_face >= face_count) return NodeState::kCorrupt;
        const auto first = static_cast<std::uint32_t>(next_face);
        out.ref[i] = {first, std::min(kLeafFaces, face_count - first)};
        next_face += kLeafFaces;
      } else {
        if (next_node <= ref.first || next_node >= node_count) return NodeState::kCorrupt;
        out.ref[i] = {next_node++, 0};
      }
    }
    return NodeState::kValid;
  }
};

}  // namespace boxtree
