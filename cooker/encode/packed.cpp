// SPDX-License-Identifier: MIT
// Encoders of packed-f32, packed-f16, packed-f64 and dedup (decoder: format/codec_packed.h).
#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "cooker/encode/encoders.h"
#include "cooker/encode/walked_nodes.h"
#include "format/codec_packed.h"

namespace boxtree::cooker {
namespace {

// Ascending, without duplicates. Cuts are never negative, and a difference never gives -0.
std::vector<float> unique_cuts(const WalkedNodes<float>& nodes) {
  std::vector<float> cuts;
  cuts.reserve(2 * nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const PlainNodeF32 node = nodes[i];
    cuts.insert(cuts.end(), {node.cut[0], node.cut[1]});
  }
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  return cuts;
}

// The bits of a cut as a field; with a table, the cut's index in the table.
std::uint64_t cut_field(std::uint16_t cut, const std::vector<float>& /*table*/) {
  return cut;
}
std::uint64_t cut_field(double cut, const std::vector<float>& /*table*/) {
  return std::bit_cast<std::uint64_t>(cut);
}
std::uint64_t cut_field(float cut, const std::vector<float>& table) {
  if (table.empty()) return std::bit_cast<std::uint32_t>(cut);
  return static_cast<std::uint64_t>(std::lower_bound(table.begin(), table.end(), cut) -
                                    table.begin());
}

// The section: header, table, and each node's fields at the place given by its kind and number.
template <class Cut>
std::vector<std::byte> pack(const WalkedNodes<Cut>& nodes, const PackedHeader& header,
                            const std::vector<float>& table) {
  const PackedPlaces places(header);
  std::vector<std::byte> bytes(places.section_bytes);
  std::memcpy(bytes.data(), &header, sizeof(header));
  if (!table.empty()) {
    std::memcpy(bytes.data() + sizeof(header), table.data(), table.size() * sizeof(float));
  }
  std::array<PackedLayout, kNodeKinds> layouts;
  for (std::size_t kind = 0; kind < kNodeKinds; ++kind) {
    layouts[kind] = PackedLayout(static_cast<NodeKind>(kind), header);
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const PlainNode<Cut> node = nodes[i];
    const auto kind = static_cast<std::size_t>(node.node_kind());
    const PackedLayout& layout = layouts[kind];
    std::byte* const array = bytes.data() + places.array_at[kind];
    const std::uint64_t at = std::uint64_t{nodes.number[i]} * layout.bits;
    write_bits(array, at, 2, node.axis());
    for (std::size_t side = 0; side < 2; ++side) {
      const std::uint32_t child = node.child[side];
      std::uint64_t number = low_bits(layout.number_bits[side]);  // of a missing child
      if (node.kind(side) == PlainChild::kLeaf) number = child;
      if (node.kind(side) == PlainChild::kSubtree) {
        number = nodes.number[child];
        write_bits(array, at + layout.kind_at[side], 2,
                   static_cast<std::uint64_t>(nodes[child].node_kind()));
      }
      write_bits(array, at + layout.number_at[side], layout.number_bits[side], number);
      write_bits(array, at + layout.cut_at[side], header.cut_bits,
                 cut_field(node.cut[side], table));
    }
  }
  return bytes;
}

// The paper's estimate before a tree exists: three nodes per face. It holds for every mesh seen;
// where it is too small or overflows, the exact width is used.
constexpr std::uint64_t kEstimatedNodesPerFace = 3;

std::uint8_t number_width(std::uint64_t exact_largest, std::uint64_t estimated_largest,
                          FieldWidths widths) {
  const std::uint8_t exact = field_width(exact_largest);
  if (widths == FieldWidths::kExact) return exact;
  const std::uint8_t estimated = field_width(estimated_largest);
  return estimated >= exact && estimated <= 32 ? estimated : exact;
}

template <class Cut>
PackedHeader header_of(const WalkedNodes<Cut>& nodes, std::uint64_t faces, FieldWidths widths) {
  PackedHeader header{};
  header.node_count = nodes.kind_count;
  // The largest number is one less than the largest count. The width fits the count, so all bits
  // set is never a node and marks a missing child.
  header.node_bits = number_width(nodes.largest_count(), kEstimatedNodesPerFace * faces, widths);
  header.face_bits = field_width(faces - 1);
  return header;
}

// The paper's choice between table and nodes: whichever is smaller (section 4.3).
void choose_table(PackedHeader& header, std::vector<float>& table, std::uint64_t faces,
                  FieldWidths widths) {
  header.cut_bits = 32;
  const std::uint64_t in_nodes = PackedPlaces(header).section_bytes;
  PackedHeader with_table = header;
  with_table.cut_count = static_cast<std::uint32_t>(table.size());
  with_table.cut_bits = number_width(table.size() - 1, 2 * kEstimatedNodesPerFace * faces, widths);
  if (PackedPlaces(with_table).section_bytes < in_nodes) {
    header = with_table;
  } else {
    table.clear();
  }
}

template <class Cut>
EncodedNodes pack_walked(const EncodedNodes& plain, CodecId codec, FieldWidths widths) {
  EncodedNodes nodes{static_cast<const NodeFacts&>(plain)};
  nodes.codec = codec;
  if (nodes.root != RootKind::kSubtree) return nodes;
  const WalkedNodes<Cut> walked(plain.bytes);
  PackedHeader header = header_of(walked, nodes.leaf_count, widths);
  std::vector<float> table;
  header.cut_bits = 8 * sizeof(Cut);
  if constexpr (std::is_same_v<Cut, float>) {
    if (codec == CodecId::kDedup) {
      table = unique_cuts(walked);
      nodes.unique_cuts = table.size();
      choose_table(header, table, nodes.leaf_count, widths);
    }
  }
  header.root_kind = static_cast<std::uint8_t>(walked[0].node_kind());
  nodes.bytes = pack(walked, header, table);
  nodes.kind_count = walked.kind_count;
  return nodes;
}

}  // namespace

EncodedNodes pack_nodes(const EncodedNodes& plain, CodecId codec, FieldWidths widths) {
  if (!is_packed(codec)) return plain;
  switch (plain_cut_of(codec)) {
    case PlainCut::kF16:
      return pack_walked<std::uint16_t>(plain, codec, widths);
    case PlainCut::kF32:
      return pack_walked<float>(plain, codec, widths);
    case PlainCut::kF64:
      break;
  }
  return pack_walked<double>(plain, codec, widths);
}

}  // namespace boxtree::cooker
