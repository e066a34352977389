// SPDX-License-Identifier: MIT
// What readers of full leaves keep of a cluster, and the fields of its leaves that no vectors are
// needed for: the same as find_leaf and decode_cluster_leaf (format/cluster.cpp).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <iterator>

#include "format/bytes.h"
#include "format/cluster_leaf.h"

#define BOXTREE_ALWAYS_INLINE [[gnu::always_inline]] inline

namespace boxtree {

// Of the fields of a leaf: steps, a bit for each third corner, and how many bits more than
// ClusterHeader::old_bits references have.
inline constexpr std::uint32_t kLeafStepBits = StripStep::kBits * (kLeafFaces - 1);
static_assert(kLeafStepBits + kLeafFaces + kOldWiderBits == 32);

/// The faces of a leaf, and where the vertices are that it refers to.
struct LeafFields {
  /// Bits of one load, by which a usual leaf's new_others and references that are not new are read.
  static constexpr std::uint32_t kWindowBits = 128;

  std::uint32_t fields = 0;      // the first 32 bits, see kLeafStepBits
  std::uint32_t aparts = 0;      // faces that share nothing with the one before
  std::uint32_t new_thirds = 0;  // bit f: the third corner of face f is new
  std::uint32_t quads = 0;       // bit f: face f is one
  std::uint32_t others = 0;      // other references: two for each of `aparts`, one for each quad
  std::uint32_t new_others = 0;  // bit r: the same for these
  std::uint32_t before = 0;      // vertices that leaves before use, less 1
  std::uint32_t last = 0;        // number of the last new vertex
  std::uint32_t old_bits = 0;    // of each reference that is not new
  const std::byte* bytes = nullptr;  // new_others, then references that are not new
  // At most 8 other references but fourth corners, and the fields of all before those in
  // kWindowBits.
  bool is_usual = false;
};

/// Where the leaves of one cluster are, and what gives the group of a vertex.
struct LeafTable {
  static constexpr std::uint32_t kNone = 0xffffffffu;

  std::uint32_t cluster = kNone;  // its number, or kNone while nothing else here is set
  const std::byte* bytes = nullptr;
  std::uint32_t size = 0;  // at which a leaf may begin
  std::uint32_t table = 0, entry_bits = 0;
  std::uint32_t start_bits = 0, starts_at = 0, start_slope = 0;
  std::uint32_t first_slope = 0, first_bias = 0;  // with 1 more
  std::uint32_t old_bits = 0;
  std::uint32_t last_vertex = 0;
  std::uint32_t group_size = 0;
  std::uint32_t per_group = 0;   // 2^16 / group_size, rounded up
  std::uint32_t quad_bytes = 0;  // that a leaf has in front of its other fields: a bit a face

  LeafTable() = default;
  BOXTREE_ALWAYS_INLINE explicit LeafTable(const ClusterView& view) noexcept
      : quad_bytes(view.corners_per_face == 4 ? kLeafFaces / 8 : 0) {}

  BOXTREE_ALWAYS_INLINE void set(std::uint32_t number, const Cluster& found) noexcept {
    const ClusterHeaderView header = found.header();
    cluster = number;
    bytes = found.bytes;
    size = static_cast<std::uint32_t>(std::min<std::uint64_t>(found.size, 0xffffffffu));
    table = found.table;
    entry_bits = found.entry_bits;
    start_bits = header.start_bits();
    start_slope = header.start_slope();
    starts_at = header.leaves_at() - header.start_bias();
    first_slope = header.first_slope();
    first_bias = header.first_bias() + 1u;
    old_bits = header.old_bits();
    last_vertex = header.vertex_count() - 1;
    group_size = header.group_size();
    per_group = 0xffffu / group_size + 1;
  }

  /// Finds leaf `self` of the cluster. False if its place is corrupt.
  BOXTREE_ALWAYS_INLINE bool find(std::uint32_t self, LeafFields& leaf) const noexcept {
    const std::uint32_t bit = table + self * entry_bits;
    const auto entry =
        static_cast<std::uint32_t>(load<std::uint64_t>(bytes + bit / 8) >> (bit % 8)) &
        ((1u << entry_bits) - 1);
    constexpr std::uint32_t kSlopeBits = ClusterHeader::kSlopeBits;
    const std::uint32_t byte =
        starts_at + (self * start_slope >> kSlopeBits) + (entry & ((1u << start_bits) - 1));
    if (byte > size) return false;
    const std::uint32_t at = byte + quad_bytes;
    leaf.quads = quad_bytes != 0 ? std::to_integer<std::uint32_t>(bytes[byte]) : 0;
    leaf.fields = load<std::uint32_t>(bytes + at);
    leaf.bytes = bytes + at + sizeof(leaf.fields);
    leaf.new_thirds = (leaf.fields >> kLeafStepBits) & 0xffu;
    leaf.old_bits = old_bits + (leaf.fields >> (kLeafStepBits + kLeafFaces));
    constexpr std::uint32_t kEachStep = 0x49249u;  // the first bit of each
    leaf.aparts = 1 + static_cast<std::uint32_t>(
                          std::popcount((leaf.fields >> 1) & (leaf.fields >> 2) & kEachStep));
    leaf.others = 2 * leaf.aparts + static_cast<std::uint32_t>(std::popcount(leaf.quads));
    leaf.new_others = load<std::uint32_t>(leaf.bytes) & ((1u << leaf.others) - 1);
    const auto new_vertices =
        static_cast<std::uint32_t>(std::popcount(leaf.new_others << kLeafFaces | leaf.new_thirds));
    leaf.before = (entry >> start_bits) + (self * first_slope >> kSlopeBits) - first_bias;
    leaf.last = leaf.before + new_vertices;
    const std::uint32_t olds = kLeafFaces + leaf.others - new_vertices;
    leaf.is_usual = leaf.quads == 0 && leaf.aparts <= kLeafFaces / 2 &&
                    leaf.others + olds * leaf.old_bits <= LeafFields::kWindowBits;
    return true;
  }
};

/// Positions of references as doubles, in tree space: x, y, z and a number that means nothing.
using DoublePositions = double[kMostLeafReferences][4];

/// Coordinates as floats: [corner][axis][triangle].
using LeafCoordinates = float[3][3][kMaxLeafTriangles];

/// The triangles of a leaf as it was read last: their corners are references to vertices. A lane is
/// a triangle; those of a quad are side by side.
struct LeafTriangles {
  /// References to the fourth corners of quads, by face.
  static constexpr std::uint32_t kFourths = 3 * kLeafFaces;

  std::uint32_t count = 0;                          // more than 8 if there are quads
  std::uint8_t code[2 * kLeafFaces];                // of each lane: 2 * face + half
  alignas(32) std::uint32_t step[kLeafFaces];       // to each face
  alignas(32) std::uint32_t corner[2][kLeafFaces];  // references of its first two corners
  // [axis]: whole numbers, or bits of floats (of doubles, rounded). Third corners of all faces, a
  // lane each; after them, the other two of those that are apart, and from kFourths on the fourth
  // corners of quads.
  alignas(64) std::uint32_t number[3][kMostLeafReferences];

  /// The face and the half of each lane. `quads`: bit f is set if face f is one.
  BOXTREE_ALWAYS_INLINE void name_lanes(std::uint32_t quads) noexcept {
    count = kLeafFaces;
    if (quads == 0) return;
    count = 0;
    for (std::uint32_t half = 0; half < 2 * kLeafFaces; ++half) {
      // Written over by the next one where there is no such half; then zeros.
      code[count] = static_cast<std::uint8_t>(half);
      count += half % 2 == 0 || ((quads >> half / 2) & 1u) != 0 ? 1 : 0;
    }
    std::fill(code + count, std::end(code), std::uint8_t{0});
  }

  /// Twice the face of a lane, and 1 more for the second triangle of a quad.
  [[nodiscard]] BOXTREE_ALWAYS_INLINE std::uint32_t face_and_half(
      std::uint32_t lane) const noexcept {
    return count == kLeafFaces ? 2 * lane : code[lane];
  }

  /// Of each step: the corner of the source that the first one of the lane is.
  alignas(32) static constexpr std::uint32_t kTurn[kLeafFaces] = {0, 1, 2, 0, 1, 2, 0, 0};
  static_assert(kTurn[StripStep::kApart] == 0 && kTurn[StripStep::code(1, 2)] == 2);

  /// The references of the corners of lane `lane`, in the order of the source.
  BOXTREE_ALWAYS_INLINE void find_corners(std::uint32_t lane, std::uint32_t (&out)[3]) const {
    static constexpr std::uint8_t kNext[] = {0, 1, 2, 0, 1};
    const std::uint32_t named = face_and_half(lane);
    const std::uint32_t in_leaf = named / 2;
    const std::uint8_t* const place = kNext + kTurn[step[in_leaf]];
    out[place[0]] = corner[0][in_leaf];
    out[place[1]] = corner[1][in_leaf];
    out[place[2]] = in_leaf;
    if (named % 2 == 0) return;
    out[1] = out[2];
    out[2] = kFourths + in_leaf;
  }

  /// The corners of lane `lane`, [corner][axis], the fourth unspecified: steps of the grid, or the
  /// floats of the source. Rows of four, so that none is written and read by halves that differ.
  BOXTREE_ALWAYS_INLINE void read_corners(std::uint32_t lane, ClusterNumbers numbers,
                                          double (&out)[3][4]) const {
    std::uint32_t references[3];
    find_corners(lane, references);
    const bool is_grid = numbers == ClusterNumbers::kGrid;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t n = number[k][references[c]];
        out[c][k] = is_grid ? static_cast<double>(static_cast<std::int32_t>(n))
                            : static_cast<double>(std::bit_cast<float>(n));
      }
    }
  }
};

}  // namespace boxtree

#undef BOXTREE_ALWAYS_INLINE
