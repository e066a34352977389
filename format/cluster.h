// SPDX-License-Identifier: MIT
// Geometry stores "exact" and "grid": faces in clusters of 64 leaves of 8. A coordinate is a whole
// number: a place on the grid, or a float of the source as a number that keeps the order of floats,
// so that both stores are lossless and coordinates that lie close together differ in few bits. A
// leaf holds the vertices that it is the first of its cluster to use, as offsets from a base of its
// own in as many bits as they need, and its faces as a strip over these and over vertices of
// earlier leaves. Any leaf can be decoded alone. A vertex has the same coordinates in every cluster
// that it is in, so that no gap opens between them.
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
inline constexpr std::size_t kClusterPadding = 64;

/// What the numbers of a store stand for.
enum class ClusterNumbers : std::uint8_t {
  kGrid,  // 32 bits: places on a grid
  kF32,   // 32 bits: floats, see float_of_number
  kF64,   // 64 bits: doubles likewise
};

/// What the numbers of a store with clusters stand for. `is_f64`: whether positions of the source
/// are.
[[nodiscard]] constexpr ClusterNumbers numbers_of(GeometryId geometry, bool is_f64) noexcept {
  if (geometry == GeometryId::kGrid) return ClusterNumbers::kGrid;
  return is_f64 ? ClusterNumbers::kF64 : ClusterNumbers::kF32;
}

/// The first bytes of a cluster. The low corner follows, a number of ClusterNumbers for each axis;
/// then the table of leaves, an entry of equal width for each; then the leaves.
struct ClusterHeader {
  /// The narrowest that all fields of an axis in an entry may be together, so that those of three
  /// axes can be read at once.
  static constexpr std::uint32_t kMostEntryBits = 8;
  static constexpr std::uint32_t kMostStartBits = 16;
  static constexpr std::uint32_t kMostOwnBits = 5;

  // Each for x, y and z:
  std::array<std::uint8_t, 3> trailing;    // zero bits taken off the end of every number
  std::array<std::uint8_t, 3> base_bits;   // of a leaf's base in its entry
  std::array<std::uint8_t, 3> base_shift;  // its unit is 2^base_shift
  std::array<std::uint8_t, 3> width;       // of a vertex's offset in the narrowest leaf
  std::array<std::uint8_t, 3> wider_bits;  // of the bits, in its entry, that a leaf has more
  std::uint8_t start_bits;                 // of a leaf's start in its entry
  std::uint16_t leaf_bytes;                // times its number, is added to that
  std::uint8_t own_bits;  // of the number that a vertex has among those of its leaf
  std::uint8_t reserved;  // zero
};
static_assert(sizeof(ClusterHeader) == 20 && std::is_trivially_copyable_v<ClusterHeader>);
static_assert(offsetof(ClusterHeader, start_bits) == 15 && offsetof(ClusterHeader, own_bits) == 18);

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

/// Most leaves whose vertices one leaf names: they and itself have a lane of a vector each. For
/// further ones it stores vertices again.
inline constexpr std::uint32_t kMaxOtherLeaves = 7;

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

/// What a leaf takes and names, for those who check it: decoders do not look at what other leaves
/// store.
struct ClusterLeafFields {
  struct Other {
    std::uint32_t leaf = 0;   // of the cluster
    std::uint32_t named = 0;  // it must store so many vertices, or more
  };
  std::uint64_t begin = 0;   // bit of `bytes` where its vertices begin
  std::uint64_t end = 0;     // bit where its faces end
  std::uint32_t stored = 0;  // vertices
  Other self;                // what it names of those that it stores
  std::uint32_t other_count = 0;
  std::array<Other, kMaxOtherLeaves> others;
};

/// Decodes leaf `leaf`: faces 8 leaf to 8 leaf + 7, or up to the last. False when its bytes are
/// corrupt. Reads nothing outside `clusters`, whatever the bytes. `fields` may be null.
/// Precondition: the leaf exists, and there are cluster_table_bytes.
[[nodiscard]] bool decode_cluster_leaf(const ClusterView& clusters, std::uint32_t leaf,
                                       ClusterLeaf& out,
                                       ClusterLeafFields* fields = nullptr) noexcept;

}  // namespace boxtree
