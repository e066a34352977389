// SPDX-License-Identifier: MIT
// Codecs packed-f32, packed-f16, packed-f64 and dedup: the paper's compressed BoxTree (chapter 3,
// tables 3.2 and 3.3). Nodes are bit fields whose widths the file states. Each kind of node has its
// own array; a node stores the kinds of its children.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <type_traits>

#include "format/binary_node.h"
#include "format/bits.h"
#include "format/half.h"
#include "format/limits.h"
#include "format/message.h"

namespace boxtree {

/// How a packed node stores its two cuts.
enum class PackedCut : std::uint8_t {
  kF16,
  kF32,
  kF64,
  kTable,  // index into the table of unique f32 cuts, or an f32 in the node if that is smaller
};

/// First bytes of the nodes section. After it come the table of cuts (cut_count f32); the arrays of
/// the four kinds in the order of NodeKind, each aligned to 8 bytes; and kBitPadding zero bytes.
struct PackedHeader {
  std::array<std::uint32_t, kNodeKinds> node_count;  // of each kind
  std::uint32_t cut_count;                           // 0: cuts are in the nodes
  std::uint8_t node_bits;                            // width of a node's number: 1..32
  std::uint8_t face_bits;                            // width of a face's number: 1..32
  std::uint8_t cut_bits;                             // width of a cut, or of its index
  std::uint8_t root_kind;                            // NodeKind of the root, number 0 of its array
  std::array<std::uint64_t, 5> reserved;             // zero
};
static_assert(sizeof(PackedHeader) == 64 && std::is_trivially_copyable_v<PackedHeader>);

/// Offsets of the fields in a node of one kind, in bits: axis (2 bits), kind of each child that is
/// a subtree (2 bits each), numbers of both children, both cuts. A missing child of a shrink node
/// has all bits of its number set and kind 0.
struct PackedLayout {
  std::array<std::uint8_t, 2> kind_at{};
  std::array<std::uint8_t, 2> number_at{};
  std::array<std::uint8_t, 2> number_bits{};
  std::array<std::uint8_t, 2> cut_at{};
  std::uint8_t bits = 0;  // of the whole node

  constexpr PackedLayout() = default;
  constexpr PackedLayout(NodeKind kind, const PackedHeader& header) noexcept {
    std::uint8_t at = 2;
    for (std::size_t side = 0; side < 2; ++side) {
      kind_at[side] = at;
      if (!is_leaf_side(kind, side)) at += 2;
    }
    for (std::size_t side = 0; side < 2; ++side) {
      number_at[side] = at;
      number_bits[side] = is_leaf_side(kind, side) ? header.face_bits : header.node_bits;
      at += number_bits[side];
    }
    for (std::size_t side = 0; side < 2; ++side) {
      cut_at[side] = at;
      at += header.cut_bits;
    }
    bits = at;
  }
};

/// Offsets of the arrays in a section, and its length, computed from the header.
struct PackedPlaces {
  std::array<std::uint64_t, kNodeKinds> array_at{};
  std::uint64_t section_bytes = 0;

  constexpr explicit PackedPlaces(const PackedHeader& header) noexcept {
    std::uint64_t at = sizeof(PackedHeader) + std::uint64_t{header.cut_count} * sizeof(float);
    for (std::size_t kind = 0; kind < kNodeKinds; ++kind) {
      at = align_up(at, 8);
      array_at[kind] = at;
      const PackedLayout layout(static_cast<NodeKind>(kind), header);
      at += (std::uint64_t{header.node_count[kind]} * layout.bits + 7) / 8;
    }
    section_bytes = at + kBitPadding;
  }
};

/// Checks the widths, counts and reserved bits of a header against the tree's counts and the kind
/// of cut. Error: kRecordInvalid, which names what is wrong.
Status check_packed_header(const PackedHeader& header, PackedCut cut, const TreeCounts& counts);

/// Decodes nodes of one tree. A subtree's NodeRef is its number and its kind.
template <PackedCut K>
struct PackedCodec {
  using Scalar = std::conditional_t<K == PackedCut::kF64, double, float>;
  using Children = ChildSet<2, Scalar>;
  static constexpr std::uint32_t kDepthLimit = kMaxDepth;

  struct Array {
    const std::byte* bits = nullptr;
    std::uint32_t count = 0;
    PackedLayout layout;
  };

  std::array<Array, kNodeKinds> arrays;
  const std::byte* cuts = nullptr;
  std::uint32_t cut_count = 0;
  std::uint8_t cut_bits = 0;
  std::uint8_t root_kind = 0;

  /// Reads the nodes of a tree out of their section. Errors: kSectionSize, kRecordInvalid.
  static Result<PackedCodec> bind(const TreeCounts& counts, Bytes section) {
    if (section.size() < sizeof(PackedHeader)) {
      return section_size_error(section.size(), sizeof(PackedHeader));
    }
    const auto header = load<PackedHeader>(section.data());
    if (Status status = check_packed_header(header, K, counts); !status) return status.error();
    const PackedPlaces places(header);
    if (section.size() != places.section_bytes) {
      return section_size_error(section.size(), places.section_bytes);
    }
    PackedCodec codec;
    for (std::size_t kind = 0; kind < kNodeKinds; ++kind) {
      codec.arrays[kind] = {section.data() + places.array_at[kind], header.node_count[kind],
                            PackedLayout(static_cast<NodeKind>(kind), header)};
    }
    codec.cuts = section.data() + sizeof(PackedHeader);
    codec.cut_count = header.cut_count;
    codec.cut_bits = header.cut_bits;
    codec.root_kind = header.root_kind;
    return codec;
  }

  [[nodiscard]] NodeRef root() const noexcept { return {0, root_kind}; }

  /// The children of the subtree `ref`, whose decoded box is `box`. kCorrupt when the axis, a child
  /// or a cut of the node does not exist. Precondition: `ref` came from root() or expand().
  [[nodiscard]] NodeState expand(NodeRef ref, const Box<Scalar>& box,
                                 Children& out) const noexcept {
    const auto kind = static_cast<NodeKind>(ref.second);
    const Array& array = arrays[ref.second];
    const PackedLayout& layout = array.layout;
    const std::uint64_t at = std::uint64_t{ref.first} * layout.bits;
    const std::uint64_t head = read_bits(array.bits, at, 6);  // axis and at most two kinds
    const auto axis = static_cast<std::size_t>(head & 3);
    if (axis > 2) return NodeState::kCorrupt;
    out.clear();
    for (std::size_t side = 0; side < 2; ++side) {
      const std::uint32_t width = layout.number_bits[side];
      const auto number =
          static_cast<std::uint32_t>(read_bits(array.bits, at + layout.number_at[side], width));
      const bool is_leaf = is_leaf_side(kind, side);
      std::uint32_t child_kind = 1;  // a leaf holds one face
      if (!is_leaf) {
        child_kind = static_cast<std::uint32_t>(head >> layout.kind_at[side]) & 3u;
        if (number == low_bits(width)) continue;  // the missing child of a shrink node
        if (number >= arrays[child_kind].count) return NodeState::kCorrupt;
      }
      Scalar cut;
      if (!read_cut(array.bits, at + layout.cut_at[side], cut)) return NodeState::kCorrupt;
      out.add(child_box(box, axis, side, cut), {number, child_kind}, is_leaf);
    }
    return NodeState::kValid;
  }

 private:
  [[nodiscard]] bool read_cut(const std::byte* bits, std::uint64_t at, Scalar& cut) const noexcept {
    if constexpr (K == PackedCut::kF16) {
      cut = half_to_float(static_cast<std::uint16_t>(read_bits(bits, at, 16)));
    } else if constexpr (K == PackedCut::kF32) {
      cut = std::bit_cast<float>(static_cast<std::uint32_t>(read_bits(bits, at, 32)));
    } else if constexpr (K == PackedCut::kF64) {
      cut = std::bit_cast<double>(read_wide_bits(bits, at, 64));
    } else {
      const auto number = static_cast<std::uint32_t>(read_bits(bits, at, cut_bits));
      if (cut_count == 0) {
        cut = std::bit_cast<float>(number);
        return true;
      }
      if (number >= cut_count) return false;
      cut = load<float>(cuts, number);
    }
    return true;
  }
};

}  // namespace boxtree
