// SPDX-License-Identifier: MIT
// Geometry stores "exact" and "grid": faces in clusters of 64 leaves of 8. A coordinate is a whole
// number: a place on the grid, or a float of the source as a number that keeps the order of floats,
// so that both stores are lossless and coordinates that lie close together differ in few bits. A
// cluster holds each of its vertices once, in the order in which its leaves first use them, in
// groups whose vertices are offsets from a base in as many bits as these need. A leaf holds its
// faces as a strip over the vertices that it is the first to use and over earlier ones. Any leaf
// can be decoded alone. A vertex has the same coordinates in every cluster that it is in, so that
// no gap opens between them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "format/bytes.h"
#include "format/codec.h"
#include "format/limits.h"

namespace boxtree {

inline constexpr std::uint32_t kClusterLeaves = 64;
inline constexpr std::uint32_t kClusterFaces = kClusterLeaves * kLeafFaces;

/// Clusters start at multiples of this many bytes, so that 32-bit offsets suffice for the largest
/// tree.
inline constexpr std::uint64_t kClusterUnit = 4;

/// Zero bytes after the last cluster: the longest leaf (see format/cluster_leaf.h) and the width of
/// one read, so that fields are read without a check each.
inline constexpr std::size_t kClusterPadding = 72;

/// What the numbers of a store stand for.
enum class ClusterNumbers : std::uint8_t {
  kGrid,  // 32 bits: places on a grid
  kF32,   // 32 bits: floats that count from the tree's origin, see float_of_number
  kF64,   // 64 bits: doubles of object space, likewise
};

/// What the numbers of a store with clusters stand for. `is_f64`: whether positions of the source
/// are.
[[nodiscard]] constexpr ClusterNumbers numbers_of(GeometryId geometry, bool is_f64) noexcept {
  if (geometry == GeometryId::kGrid) return ClusterNumbers::kGrid;
  return is_f64 ? ClusterNumbers::kF64 : ClusterNumbers::kF32;
}

/// The first bytes of a cluster. The low corner follows, a number of ClusterNumbers for each axis;
/// then the table of leaves, an entry of equal width for each; then what each group has of its own,
/// an axis after the other: bases, a byte each, and by how much their offsets are wider, kWiderBits
/// each; then the vertices of all groups; then the leaves. So one may look for a leaf before the
/// groups are known.
struct ClusterHeader {
  /// As many as a byte shuffle looks up.
  static constexpr std::uint32_t kMostGroups = 16;
  static constexpr std::uint32_t kLeastGroupSize = 2;
  /// So that groups hold every corner of kClusterFaces quads.
  static constexpr std::uint32_t kMostGroupSize = 128;
  /// Up to here, the group of a vertex follows from a product of 16 bits by 2^16 over the size,
  /// rounded up: as numbers are less than kMostGroups times the size, the error is less than
  /// kMostGroups size / 2^16 < 1 / size. Writers use larger ones only where they must.
  static constexpr std::uint32_t kFastGroupSize = 63;
  static_assert(kMostGroups * kFastGroupSize * kFastGroupSize < 1u << 16);
  static constexpr std::uint32_t kBaseBits = 8;
  static constexpr std::uint32_t kWiderBits = 4;
  static constexpr std::uint32_t kMostStartBits = 16;
  static constexpr std::uint32_t kMostFirstBits = 11;
  static constexpr std::uint32_t kMostOldBits = 4;
  /// Slopes count in units of 2^-kSlopeBits.
  static constexpr std::uint32_t kSlopeBits = 3;

  // Each for x, y and z:
  std::array<std::uint8_t, 3> trailing;    // zero bits taken off the end of every number
  std::array<std::uint8_t, 3> base_shift;  // the unit of bases is 2^base_shift
  std::array<std::uint8_t, 3> width;       // of a vertex's offset in the narrowest group
  std::uint8_t group_size;                 // vertices; the last group may have fewer
  std::uint16_t vertex_count;              // of the cluster
  std::uint16_t leaves_at;                 // byte where the vertices end and leaves begin
  // Leaf i starts at byte leaves_at + (i * start_slope >> kSlopeBits) + its start - start_bias; its
  // first vertex is number (i * first_slope >> kSlopeBits) + its first - first_bias.
  std::uint16_t start_slope;
  std::uint16_t start_bias;
  std::uint16_t first_bias;
  std::uint8_t first_slope;
  std::uint8_t start_bits;  // of a leaf's start in its entry
  std::uint8_t first_bits;  // of its first vertex there
  std::uint8_t old_bits;    // of references in the leaf with the narrowest
};
static_assert(sizeof(ClusterHeader) == 24 && std::is_trivially_copyable_v<ClusterHeader>);
static_assert(offsetof(ClusterHeader, group_size) == 9 && offsetof(ClusterHeader, old_bits) == 23);
static_assert(ClusterHeader::kMostGroups * ClusterHeader::kMostGroupSize == 4 * kClusterFaces);

[[nodiscard]] constexpr std::uint32_t clusters_of(std::uint32_t faces) noexcept {
  return faces / kClusterFaces + (faces % kClusterFaces != 0 ? 1 : 0);
}

/// Bytes in front of the clusters that say where they begin.
[[nodiscard]] constexpr std::uint64_t cluster_table_bytes(std::uint32_t faces) noexcept {
  return clusters_of(faces) * sizeof(std::uint32_t);
}

/// How a face of a strip follows from the previous one. Edges of a face are numbered like the
/// corner they begin at. A face is entered by the edge that it shares with the one before, or by
/// edge 0. It is left by one of the other two: the first after that edge (side 0) or the second
/// (side 1). The shared edge, reversed, is the edge `turn` of the next face, which adds its third
/// corner. Code 6 shares nothing and adds all three; 7 is corrupt.
struct StripStep {
  static constexpr std::uint32_t kBits = 3;
  static constexpr std::uint32_t kApart = 6;

  [[nodiscard]] static constexpr std::uint32_t code(std::uint32_t side,
                                                    std::uint32_t turn) noexcept {
    return 3 * side + turn;
  }
};

/// The clusters of one tree, as stored in the file.
struct ClusterView {
  /// For each cluster, a u32: where it begins in these bytes, in units of kClusterUnit. Then all
  /// clusters, and kClusterPadding.
  Bytes bytes;
  std::uint32_t face_count = 0;
  std::uint32_t corners_per_face = 3;
  ClusterNumbers numbers = ClusterNumbers::kGrid;
};

/// Most references of a leaf to vertices: every face is a quad and apart.
inline constexpr std::size_t kMostLeafReferences = std::size_t{4} * kLeafFaces;

/// A decoded leaf. Corrupt bytes may give any positions, NaN and infinities included.
struct ClusterLeaf {
  static constexpr std::uint8_t kNoCorner = 0xff;

  std::uint32_t vertex_count = 0;  // one for each reference, so that some are the same
  std::uint32_t face_count = 0;
  std::array<std::array<double, 3>, kMostLeafReferences> position;  // steps of the grid, or floats
  std::array<std::array<std::uint8_t, 4>, kLeafFaces> corner;       // indices into `position`
};

/// Where a leaf is, for those who check what lies between leaves.
struct ClusterLeafFields {
  std::uint64_t begin = 0;         // bit of `bytes` where it begins
  std::uint64_t end = 0;           // and where it ends
  std::uint32_t first = 0;         // number of the first vertex that it is the first to use
  std::uint32_t new_vertices = 0;  // how many of them there are
  bool has_width_of_none = false;  // says how wide old references are, but has none
};

}  // namespace boxtree
