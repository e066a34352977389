// SPDX-License-Identifier: MIT
// Section active_edges: which edges of triangles are active. Most leaves have none, or all of them;
// edges of the others are looked up by the positions of their ends, so that triangles that share an
// edge share its bit. Such a bit is the parity of some of 64 bits that a hash of the edge selects
// (Dillinger, Walzer, "Ribbon filter: practically smaller than Bloom and Xor", 2021).
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "format/bits.h"
#include "format/bytes.h"
#include "format/limits.h"

namespace boxtree {

/// What the section begins with; the codes of leaves follow, then the bits of edges.
struct ActiveEdgesHeader {
  float degrees;              // by more than that a surface bends at active edges
  std::uint32_t start_count;  // 64 bits begin at each of so many bits; 0: there are none
  std::uint32_t seed;         // of hashes
  std::uint8_t is_by_face;    // 1: faces at an edge may differ: each has bits of its own
  std::uint8_t zero[3];
};
static_assert(sizeof(ActiveEdgesHeader) == 16 && std::is_trivially_copyable_v<ActiveEdgesHeader>);
static_assert(offsetof(ActiveEdgesHeader, is_by_face) == 12);

/// What the code of a leaf, faces 8n to 8n + 7, says of all its triangles with an area.
enum class LeafEdges : std::uint8_t {
  kNone = 0,   // no edge is active
  kAll = 1,    // all are
  kMixed = 2,  // each edge has a bit
};
inline constexpr std::uint32_t kLeafEdgesBits = 2;
/// How many bits may decide on that of an edge.
inline constexpr std::uint32_t kEdgeBits = 64;

[[nodiscard]] constexpr std::uint64_t leaf_edges_bytes(std::uint32_t faces) noexcept {
  const std::uint64_t leaves = (std::uint64_t{faces} + kLeafFaces - 1) / kLeafFaces;
  return (leaves * kLeafEdgesBits + 7) / 8;
}
[[nodiscard]] constexpr std::uint64_t edge_bits_bytes(std::uint32_t start_count) noexcept {
  return start_count == 0 ? 0 : (std::uint64_t{start_count} + kEdgeBits - 1 + 7) / 8 + kBitPadding;
}
/// Bytes of the section of a tree with so many faces.
[[nodiscard]] constexpr std::uint64_t active_edges_bytes(std::uint32_t faces,
                                                         std::uint32_t start_count) noexcept {
  return sizeof(ActiveEdgesHeader) + leaf_edges_bytes(faces) + edge_bits_bytes(start_count);
}

/// Where the 64 bits of an edge begin, and which of them count.
struct EdgeBits {
  std::uint32_t start;
  std::uint64_t selected;  // the first bit is

  /// Precondition: start_count > 0.
  [[nodiscard]] static constexpr EdgeBits of(std::uint64_t hash,
                                             std::uint32_t start_count) noexcept {
    constexpr std::uint64_t kOdd = 0x9e3779b97f4a7c15;
    return {static_cast<std::uint32_t>((hash >> 32) * start_count >> 32),
            std::rotl(hash * kOdd, 32) | 1u};
  }
};

/// The section of one tree, or none.
class ActiveEdgesView {
 public:
  ActiveEdgesView() noexcept = default;
  /// Precondition: section.size() == active_edges_bytes(faces, its start_count).
  ActiveEdgesView(Bytes section, std::uint32_t faces) noexcept
      : section_(section.data()),
        bits_(section.data() + sizeof(ActiveEdgesHeader) + leaf_edges_bytes(faces)) {}

  explicit operator bool() const noexcept { return section_ != nullptr; }

  [[nodiscard]] ActiveEdgesHeader header() const noexcept {
    return load<ActiveEdgesHeader>(section_);
  }
  /// Of the leaf of a face, which exists. Where the bytes are corrupt, all edges are active.
  [[nodiscard]] LeafEdges leaf_of(std::uint32_t face) const noexcept {
    const std::uint32_t leaf = face / kLeafFaces;
    const auto codes = load<std::uint8_t>(section_ + sizeof(ActiveEdgesHeader), leaf / 4);
    const auto code = static_cast<LeafEdges>(codes >> leaf % 4 * kLeafEdgesBits & 3u);
    const bool is_valid =
        code == LeafEdges::kNone || (code == LeafEdges::kMixed && header().start_count != 0);
    return is_valid ? code : LeafEdges::kAll;
  }
  /// The bit of an edge with that hash. Precondition: leaf_of() its face is kMixed.
  [[nodiscard]] bool bit_of(std::uint64_t hash) const noexcept {
    const EdgeBits edge = EdgeBits::of(hash, header().start_count);
    return std::popcount(read_wide_bits(bits_, edge.start, kEdgeBits) & edge.selected) % 2 != 0;
  }

 private:
  const std::byte* section_ = nullptr;
  const std::byte* bits_ = nullptr;
};

}  // namespace boxtree
