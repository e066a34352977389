// SPDX-License-Identifier: MIT
// Decodes which vertices the faces of one leaf of the grid store have: the part of its decoding
// that goes bit by bit (encoder: cooker/encode/grid_geometry.cpp; format: docs/FORMAT.md 8.1).
// Always inlined, because walks compile it once per instruction set.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "format/bits.h"
#include "format/grid.h"

#define BOXTREE_ALWAYS_INLINE [[gnu::always_inline]] inline

namespace boxtree {

/// The faces of a leaf. Their corners are indices into the list of vertices that the leaf names.
struct GridLeafFaces {
  std::uint32_t face_count = 0;
  std::uint32_t vertex_count = 0;
  std::array<std::array<std::uint8_t, 4>, kLeafFaces> corner;  // indices, or kNoCorner
  std::array<std::uint16_t, kMaxLeafVertices + 1> vertex;      // of the cluster; the last is unused
};

/// Where the offsets of a cluster's vertices lie.
struct GridOffsets {
  std::array<std::int32_t, 3> origin;
  std::array<std::uint32_t, 3> width;
  std::uint32_t stride = 0;  // bits from one vertex to the next
  std::uint64_t start = 0;   // bit of the first one
};

/// Where the fields of a leaf lie, in bits of the section.
struct GridLeafBits {
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
};

namespace grid_detail {

// Why no read leaves the section: the fields for the starts of leaves take at most 34 bytes; a leaf
// starts inside the bytes of its cluster, which end at least kClusterPadding before the section
// does; and a leaf has at most 32 references of 12 bits, 8 steps of 5 and one number of 10: 434
// bits.
static_assert(kClusterPadding >= 434 / 8 + 1 + 8);

// Reads the fields of a leaf in order. After a refill a window holds at least 57 bits: enough for
// the first face and the number before it (10 + 1 + 4 x 12), one face of four corners (1 + 4 + 4 x
// 12), or three faces that continue a strip (4 + 12 each).
class LeafBits {
 public:
  LeafBits(const std::byte* bytes, std::uint64_t position) : bytes_(bytes), position_(position) {}

  BOXTREE_ALWAYS_INLINE void refill() {
    window_ = load<std::uint64_t>(bytes_ + position_ / 8) >> (position_ % 8);
  }
  [[nodiscard]] BOXTREE_ALWAYS_INLINE std::uint64_t window() const { return window_; }
  [[nodiscard]] BOXTREE_ALWAYS_INLINE std::uint64_t position() const { return position_; }
  BOXTREE_ALWAYS_INLINE void skip(std::uint32_t width) {
    window_ >>= width;
    position_ += width;
  }
  [[nodiscard]] BOXTREE_ALWAYS_INLINE std::uint32_t take(std::uint32_t width) {
    const auto field = static_cast<std::uint32_t>(window_ & ((std::uint64_t{1} << width) - 1));
    skip(width);
    return field;
  }

 private:
  const std::byte* bytes_;
  std::uint64_t position_;
  std::uint64_t window_ = 0;
};

// `one` where `bit` is 1, `other` where it is 0. Compilers would turn the operator ?: into a
// branch, and these bits are unpredictable.
BOXTREE_ALWAYS_INLINE std::uint32_t select(std::uint32_t bit, std::uint32_t one,
                                           std::uint32_t other) {
  return other ^ ((one ^ other) & (0u - bit));
}

// The vertices that a leaf has named so far.
class LeafVertices {
 public:
  BOXTREE_ALWAYS_INLINE LeafVertices(std::uint32_t first_new, std::uint32_t vertex_count,
                                     GridLeafFaces& out)
      : out_(out), next_(first_new), vertex_count_(vertex_count) {}

  // A reference: 1 for the next vertex of the cluster, after the last one named this way; 01 and
  // the number of an earlier vertex of the cluster; 00 and the place of a vertex that this leaf has
  // named before. The kind is unpredictable, so nothing here is a branch. On any bytes a reference
  // has at most 12 bits: numbers are below 512, the vertices that a cluster may have, plus 32,
  // those that a leaf may name.
  [[nodiscard]] BOXTREE_ALWAYS_INLINE std::uint32_t take(LeafBits& bits) {
    const auto window = static_cast<std::uint32_t>(bits.window());
    const std::uint32_t is_next = window & 1u;
    const std::uint32_t is_new = (window | (window >> 1)) & 1u;
    // Both widths are computed before the kind is known, so that only a selection depends on it.
    const std::uint32_t width =
        select(is_new, width_below(next_), width_below(count_)) & (is_next - 1);
    const std::uint32_t field = (window >> 2) & ((1u << width) - 1);
    bits.skip(2 - is_next + width);
    const std::uint32_t vertex = select(is_next, next_, field);
    const std::uint32_t place = select(is_new, count_, field);
    out_.vertex[count_] = static_cast<std::uint16_t>(vertex);
    count_ += is_new;
    next_ += is_next;
    // Both differences are negative for a valid reference. (The place of a vertex that was named
    // before is always less than the number of vertices.)
    negative_ &= (vertex - vertex_count_) & (place - count_);
    return place;
  }

  [[nodiscard]] bool are_valid() const { return (negative_ >> 31) != 0; }
  [[nodiscard]] std::uint32_t count() const { return count_; }

 private:
  GridLeafFaces& out_;
  std::uint32_t count_ = 0;
  std::uint32_t next_;
  std::uint32_t vertex_count_;
  std::uint32_t negative_ = 0xffffffffu;  // only the highest bit counts
};

// Finds where leaf `leaf` starts, in bits, and the offsets of its cluster. False if they are
// corrupt.
BOXTREE_ALWAYS_INLINE bool find_grid_leaf(const GridView& grid, std::uint32_t leaf,
                                          std::uint32_t& vertex_count, GridOffsets& offsets,
                                          std::uint64_t& leaf_start) {
  const auto cluster = load<ClusterRecord>(grid.clusters, leaf / kClusterLeaves);
  const std::uint64_t start = cluster.offset * kClusterUnit;
  if (cluster.leaf_bits > 16 || !in_range(start, kClusterPadding, grid.bytes.size())) return false;
  const std::byte* const bytes = grid.bytes.data();
  const std::uint32_t faces_left = grid.face_count - leaf / kClusterLeaves * kClusterFaces;
  const auto leaves = static_cast<std::uint32_t>(leaves_of(std::min(faces_left, kClusterFaces)));
  const std::uint64_t first_leaf = ((leaves + 1) * cluster.leaf_bits + 7) / 8;
  // Offsets in the cluster, in bytes: of the leaf, and of what follows the last leaf.
  std::uint64_t at[2];
  const std::uint64_t number[2] = {leaf % kClusterLeaves, leaves};
  for (std::size_t i = 0; i < 2; ++i) {
    at[i] = first_leaf + number[i] * cluster.leaf_bytes +
            read_bits(bytes, start * 8 + number[i] * cluster.leaf_bits, cluster.leaf_bits);
  }
  const std::uint64_t leaf_at = at[0], vertices_at = at[1];
  offsets.origin = cluster.origin;
  offsets.width = {cluster.width[0], cluster.width[1], cluster.width[2]};
  const std::uint32_t widest = std::max({offsets.width[0], offsets.width[1], offsets.width[2]});
  offsets.stride = offsets.width[0] + offsets.width[1] + offsets.width[2];
  const std::uint64_t size =
      vertices_at + (std::uint64_t{cluster.vertex_count} * offsets.stride + 7) / 8;
  constexpr std::uint32_t kMostVertices = kClusterFaces * 4;
  if (widest > 32 || cluster.vertex_count == 0 || cluster.vertex_count > kMostVertices ||
      leaf_at > vertices_at || !in_range(start, size + kClusterPadding, grid.bytes.size())) {
    return false;
  }
  vertex_count = cluster.vertex_count;
  offsets.start = (start + vertices_at) * 8;
  leaf_start = (start + leaf_at) * 8;
  return true;
}

// The corners of a face in one word, a byte each, the first one lowest.
inline constexpr std::uint32_t kCornerBits = 8;
inline constexpr std::uint32_t kTriangleBits = 3 * kCornerBits;

// Rotations of a strip step, in bits: of the previous face's corners, so that the shared edge comes
// first, and of this face's corners into their order.
struct StripTurn {
  std::uint8_t before;
  std::uint8_t after;
};
inline constexpr auto kStripTurns = [] {
  std::array<StripTurn, StripStep::kApart> turns{};
  for (std::uint32_t edge = 0; edge < 3; ++edge) {
    for (std::uint32_t turn = 0; turn < 3; ++turn) {
      turns[StripStep::code(edge, turn)] = {
          static_cast<std::uint8_t>(edge * kCornerBits),
          static_cast<std::uint8_t>((3 - turn) % 3 * kCornerBits)};
    }
  }
  return turns;
}();

// Rotates three corners down by `bits`, a multiple of kCornerBits.
BOXTREE_ALWAYS_INLINE std::uint32_t turned(std::uint32_t corners, std::uint32_t bits) {
  const std::uint64_t twice = corners | (std::uint64_t{corners} << kTriangleBits);
  return static_cast<std::uint32_t>(twice >> bits) & ((1u << kTriangleBits) - 1);
}

// Reads three references.
BOXTREE_ALWAYS_INLINE std::uint32_t take_triangle(LeafBits& bits, LeafVertices& vertices) {
  std::uint32_t corners = vertices.take(bits);
  corners |= vertices.take(bits) << kCornerBits;
  corners |= vertices.take(bits) << (2 * kCornerBits);
  return corners;
}

// The triangle after the previous one, or the first of a quad; false for an invalid code.
BOXTREE_ALWAYS_INLINE bool take_next(LeafBits& bits, LeafVertices& vertices, bool may_be_quad,
                                     std::uint32_t& corners) {
  const std::uint32_t step = bits.take(StripStep::kBits);
  if (step >= StripStep::kApart) {
    if (step > StripStep::kApart) return false;
    bits.refill();
    corners = take_triangle(bits, vertices);
    if (!may_be_quad) bits.refill();
    return true;
  }
  const std::uint32_t edge = turned(corners, kStripTurns[step].before);
  const std::uint32_t swapped = ((edge >> kCornerBits) & 0xffu) | ((edge & 0xffu) << kCornerBits);
  const std::uint32_t third = vertices.take(bits) << (2 * kCornerBits);
  corners = turned(swapped | third, kStripTurns[step].after);
  return true;
}

// The corners of a face, with the fourth one of a quad.
BOXTREE_ALWAYS_INLINE std::array<std::uint8_t, 4> with_fourth(std::uint32_t corners, bool is_quad,
                                                              LeafBits& bits,
                                                              LeafVertices& vertices) {
  const std::uint32_t fourth = is_quad ? vertices.take(bits) : GridLeaf::kNoCorner;
  return std::bit_cast<std::array<std::uint8_t, 4>>(corners | (fourth << kTriangleBits));
}

}  // namespace grid_detail

/// Reads the faces of leaf `leaf` and the place of its cluster's offsets; otherwise as
/// decode_grid_leaf. All vertices named exist in the cluster. `may_be_quad`: whether faces of the
/// store can have four corners; a constant where speed matters. `place` may be null.
BOXTREE_ALWAYS_INLINE bool read_grid_faces(const GridView& grid, std::uint32_t leaf,
                                           bool may_be_quad, GridLeafFaces& out,
                                           GridOffsets& offsets,
                                           GridLeafBits* place = nullptr) noexcept {
  using namespace grid_detail;
  std::uint32_t vertex_count = 0;
  std::uint64_t leaf_start = 0;
  if (!find_grid_leaf(grid, leaf, vertex_count, offsets, leaf_start)) return false;
  LeafBits bits(grid.bytes.data(), leaf_start);
  bits.refill();
  const std::uint32_t first_new = bits.take(width_below(vertex_count + 1));
  if (first_new > vertex_count) return false;
  LeafVertices vertices(first_new, vertex_count, out);
  out.face_count = std::min(kLeafFaces, grid.face_count - leaf * kLeafFaces);
  bool is_quad = may_be_quad && bits.take(1) != 0;
  std::uint32_t corners = take_triangle(bits, vertices);
  out.corner[0] = with_fourth(corners, is_quad, bits, vertices);
  const std::uint32_t refills = may_be_quad ? 0xff : 0b10010010;  // bit f: refill before face f
  for (std::uint32_t f = 1; f < out.face_count; ++f) {
    if (((refills >> f) & 1u) != 0) bits.refill();
    is_quad = may_be_quad && bits.take(1) != 0;
    if (!take_next(bits, vertices, may_be_quad, corners)) return false;
    out.corner[f] = with_fourth(corners, is_quad, bits, vertices);
  }
  out.vertex_count = vertices.count();
  if (place != nullptr) *place = {leaf_start, bits.position()};
  return vertices.are_valid();
}

}  // namespace boxtree

#undef BOXTREE_ALWAYS_INLINE
