// SPDX-License-Identifier: MIT
// Passes over plain nodes once per encoding.
#include "cooker/report/node_counts.h"

#include <cmath>
#include <vector>

#include "cooker/encode/walked_nodes.h"
#include "format/bits.h"
#include "format/numbers.h"

namespace boxtree::cooker {
namespace {

bool is_shrink(const PlainNodeF32& node) {
  return node.kind(0) == PlainChild::kNone || node.kind(1) == PlainChild::kNone;
}

using Nodes = WalkedNodes<float>;

double count_whole_bytes(const Nodes& nodes, std::uint32_t faces, double cut_bytes) {
  const double face_bytes = number_bytes(faces - 1);
  const double node_bytes = number_bytes(nodes.largest_count());
  double bytes = 0;
  for (std::size_t kind = 0; kind < kNodeKinds; ++kind) {
    double node = 1 + 2 * cut_bytes;  // axis and kinds of children share a byte
    for (std::size_t side = 0; side < 2; ++side) {
      node += is_leaf_side(static_cast<NodeKind>(kind), side) ? face_bytes : node_bytes;
    }
    bytes += node * nodes.kind_count[kind];
  }
  return bytes;
}

// A length byte, then axis, kinds, the width of each number (5 bits), the numbers and both cuts.
double count_own_sizes(const Nodes& nodes) {
  double bytes = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const PlainNodeF32 node = nodes[i];
    double bits = 2 + 2 * 16;
    for (std::size_t side = 0; side < 2; ++side) {
      const std::uint32_t child = node.child[side];
      bits += 5;
      if (node.kind(side) == PlainChild::kSubtree) bits += 2 + field_width(nodes.number[child]);
      if (node.kind(side) == PlainChild::kLeaf) bits += field_width(child);
    }
    bytes += 1 + std::ceil(bits / 8);
  }
  return bytes;
}

// Number of nodes if each absorbs `levels` levels of subtrees, from the root down.
std::size_t count_collapsed(const Nodes& nodes, int levels) {
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
    const PlainNodeF32 node = nodes[item.node];
    for (std::size_t side = 0; side < 2; ++side) {
      if (node.kind(side) != PlainChild::kSubtree) continue;
      stack.push_back({node.child[side], (item.level + 1) % levels});
    }
  }
  return count;
}

// packed-f16 with exact widths. With `own_kinds`, shrink nodes are two extra kinds, so the kind of
// a child takes 3 bits instead of 2.
double count_packed(const Nodes& nodes, std::uint32_t faces, bool own_kinds) {
  const double kind_bits = own_kinds ? 3 : 2;
  const double face_bits = field_width(faces - 1);
  const double node_bits = field_width(nodes.largest_count());
  double bits = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const PlainNodeF32 node = nodes[i];
    if (own_kinds && is_shrink(node)) {
      bits += 2 + kind_bits + node_bits + 16;
      continue;
    }
    bits += 2 + 2 * 16;
    const NodeKind kind = node.node_kind();
    for (std::size_t side = 0; side < 2; ++side) {
      bits += is_leaf_side(kind, side) ? face_bits : kind_bits + node_bits;
    }
  }
  return std::ceil(bits / 8);
}

}  // namespace

CountedSizes count_sizes(const EncodedNodes& tree, std::uint32_t faces) {
  const Nodes nodes(tree.bytes);
  CountedSizes sizes;
  constexpr double kImplicitNodeBytes = 8;
  sizes.implicit_slots = std::exp2(static_cast<double>(tree.depth)) - 1;
  sizes.implicit = kImplicitNodeBytes * sizes.implicit_slots;
  sizes.whole_bytes_f16 = count_whole_bytes(nodes, faces, sizeof(std::uint16_t));
  sizes.whole_bytes_f32 = count_whole_bytes(nodes, faces, sizeof(float));
  sizes.own_sizes = count_own_sizes(nodes);
  // Axes and kinds in 4 bytes; 4 numbers and 6 cuts, or 8 numbers and 14 cuts.
  constexpr double kBranching4Bytes = 4 + 4 * 4 + 6 * 2;
  constexpr double kBranching8Bytes = 4 + 8 * 4 + 14 * 2;
  sizes.branching4 = kBranching4Bytes * static_cast<double>(count_collapsed(nodes, 2));
  sizes.branching8 = kBranching8Bytes * static_cast<double>(count_collapsed(nodes, 3));
  sizes.two_cut_shrink = count_packed(nodes, faces, false);
  sizes.one_cut_shrink = count_packed(nodes, faces, true);
  return sizes;
}

}  // namespace boxtree::cooker
