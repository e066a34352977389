// SPDX-License-Identifier: MIT
// One pass over plain nodes for each way to store them.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

#include <boxtree/cooker/report/node_counts.h>
#include <boxtree/format/codec_plain.h>

namespace boxtree::cooker {
namespace {

NodeKind kind_of(const PlainNodeF32& node) {
  const bool left = node.kind(0) == PlainChild::kLeaf;
  const bool right = node.kind(1) == PlainChild::kLeaf;
  if (left && right) return NodeKind::kTwoLeaves;
  if (left) return NodeKind::kLeftLeaf;
  return right ? NodeKind::kRightLeaf : NodeKind::kNoLeaves;
}

bool is_shrink(const PlainNodeF32& node) {
  return node.kind(0) == PlainChild::kNone || node.kind(1) == PlainChild::kNone;
}

double bits_for(std::uint64_t largest) {
  return std::max(1, static_cast<int>(std::bit_width(largest)));
}

double whole_bytes_for(std::uint64_t largest) {
  return largest <= 0xff ? 1 : largest <= 0xffff ? 2 : 4;
}

// The tree as an array of nodes, and for each its number among those of its kind.
struct Counted {
  std::vector<PlainNodeF32> nodes;
  std::vector<std::uint32_t> number;
  std::array<std::uint32_t, kNodeKinds> count{};

  explicit Counted(const EncodedNodes& encoded) {
    for (std::size_t i = 0; i < encoded.node_count; ++i) {
      nodes.push_back(load<PlainNodeF32>(encoded.bytes.data(), i));
      number.push_back(count[static_cast<std::size_t>(kind_of(nodes.back()))]++);
    }
  }
  [[nodiscard]] std::uint32_t largest() const {
    return *std::max_element(count.begin(), count.end());
  }
};

double count_whole_bytes(const Counted& tree, std::uint32_t faces, double cut_bytes) {
  const double face_bytes = whole_bytes_for(faces - 1);
  const double node_bytes = whole_bytes_for(tree.largest());
  double bytes = 0;
  for (std::size_t kind = 0; kind < kNodeKinds; ++kind) {
    double node = 1 + 2 * cut_bytes;  // axis and kinds of children share a byte
    for (std::size_t side = 0; side < 2; ++side) {
      node += is_leaf_side(static_cast<NodeKind>(kind), side) ? face_bytes : node_bytes;
    }
    bytes += node * tree.count[kind];
  }
  return bytes;
}

// A length byte, then axis, kinds, the width of each number (5 bits), the numbers and both cuts.
double count_own_sizes(const Counted& tree) {
  double bytes = 0;
  for (const PlainNodeF32& node : tree.nodes) {
    double bits = 2 + 2 * 16;
    for (std::size_t side = 0; side < 2; ++side) {
      const std::uint32_t child = node.child[side];
      bits += 5;
      if (node.kind(side) == PlainChild::kSubtree) bits += 2 + bits_for(tree.number[child]);
      if (node.kind(side) == PlainChild::kLeaf) bits += bits_for(child);
    }
    bytes += 1 + std::ceil(bits / 8);
  }
  return bytes;
}

// Nodes that are left when each takes `levels` levels of subtrees into itself, from the root down.
std::size_t count_collapsed(const Counted& tree, int levels) {
  struct Item {
    std::uint32_t node;
    int level;  // within the collapsed node
  };
  std::size_t count = 0;
  std::vector<Item> stack = {{0, 0}};
  while (!stack.empty()) {
    const Item item = stack.back();
    stack.pop_back();
    count += item.level == 0 ? 1u : 0u;
    for (std::size_t side = 0; side < 2; ++side) {
      if (tree.nodes[item.node].kind(side) != PlainChild::kSubtree) continue;
      stack.push_back({tree.nodes[item.node].child[side], (item.level + 1) % levels});
    }
  }
  return count;
}

// packed-f16 with exact widths; with `own_kinds`, shrink nodes are two more kinds, which makes the
// kind of a child 3 bits instead of 2.
double count_packed(const Counted& tree, std::uint32_t faces, bool own_kinds) {
  const double kind_bits = own_kinds ? 3 : 2;
  const double face_bits = bits_for(faces - 1);
  const double node_bits = bits_for(tree.largest());
  double bits = 0;
  for (const PlainNodeF32& node : tree.nodes) {
    if (own_kinds && is_shrink(node)) {
      bits += 2 + kind_bits + node_bits + 16;
      continue;
    }
    bits += 2 + 2 * 16;
    const NodeKind kind = kind_of(node);
    for (std::size_t side = 0; side < 2; ++side) {
      bits += is_leaf_side(kind, side) ? face_bits : kind_bits + node_bits;
    }
  }
  return std::ceil(bits / 8);
}

}  // namespace

CountedSizes count_sizes(const EncodedNodes& nodes, std::uint32_t faces) {
  const Counted tree(nodes);
  CountedSizes sizes;
  constexpr double kImplicitNodeBytes = 8;
  sizes.implicit_slots = std::exp2(static_cast<double>(nodes.depth)) - 1;
  sizes.implicit = kImplicitNodeBytes * sizes.implicit_slots;
  sizes.whole_bytes_f16 = count_whole_bytes(tree, faces, sizeof(std::uint16_t));
  sizes.whole_bytes_f32 = count_whole_bytes(tree, faces, sizeof(float));
  sizes.own_sizes = count_own_sizes(tree);
  // Axes and kinds in 4 bytes; 4 numbers and 6 cuts, or 8 numbers and 14 cuts.
  constexpr double kBranching4Bytes = 4 + 4 * 4 + 6 * 2;
  constexpr double kBranching8Bytes = 4 + 8 * 4 + 14 * 2;
  sizes.branching4 = kBranching4Bytes * static_cast<double>(count_collapsed(tree, 2));
  sizes.branching8 = kBranching8Bytes * static_cast<double>(count_collapsed(tree, 3));
  sizes.two_cut_shrink = count_packed(tree, faces, false);
  sizes.one_cut_shrink = count_packed(tree, faces, true);
  return sizes;
}

}  // namespace boxtree::cooker
