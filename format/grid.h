// SPDX-License-Identifier: MIT
// Geometry store "grid": corners with integer coordinates, in clusters of 16 leaves of 8 faces. A
// cluster holds each of its vertices once, as an offset from the cluster's origin in as many bits
// as its extent needs. A leaf is a strip of faces over these vertices and can be decoded alone. A
// vertex has the same coordinates in every cluster that it is in, so that no gap opens between
// them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "format/bytes.h"
#include "format/limits.h"

namespace boxtree {

inline constexpr std::uint32_t kClusterLeaves = 16;
inline constexpr std::uint32_t kClusterFaces = kClusterLeaves * kLeafFaces;

/// Clusters start at multiples of this many bytes, so that 32-bit offsets suffice for the largest
/// tree.
inline constexpr std::uint64_t kClusterUnit = 4;

/// Bits of a grid over the largest extent: the range that writers offer and readers rely on.
inline constexpr int kMinGridBits = 8;
inline constexpr int kMaxGridBits = 30;

/// Zero bytes after the last cluster: the longest leaf (see docs/FORMAT.md) and the width of one
/// read, so that fields are read without a check each.
inline constexpr std::size_t kClusterPadding = 96;

/// Place and field widths of a cluster. Cluster n holds faces 128 n to 128 n + 127. Its bytes: one
/// field of leaf_bits per leaf, and one more; the leaves, each starting at a whole byte; the
/// offsets of its vertices. Leaf i starts i * leaf_bytes plus its field after these fields. The
/// offsets of vertices start where one more leaf would. So any leaf is found in constant time.
struct ClusterRecord {
  std::array<std::int32_t, 3> origin;  // grid coordinates of the low corner
  std::uint32_t offset;  // of its bytes in the section, in units of kClusterUnit bytes
  std::uint16_t vertex_count;
  std::array<std::uint8_t, 3> width;  // bits of a vertex's offset on each axis, at most 32
  std::uint8_t leaf_bytes;            // smallest (start of leaf i) / i
  std::uint8_t leaf_bits;             // at most 16
  std::uint8_t reserved;              // zero
};
static_assert(sizeof(ClusterRecord) == 24 && std::is_trivially_copyable_v<ClusterRecord>);
static_assert(offsetof(ClusterRecord, width) == 18 && offsetof(ClusterRecord, leaf_bits) == 22);

[[nodiscard]] constexpr std::uint32_t clusters_of(std::uint32_t faces) noexcept {
  return faces / kClusterFaces + (faces % kClusterFaces != 0 ? 1 : 0);
}

/// How a face of a strip follows from the previous one, whose corners are p. It shares the edge
/// from p[(edge + 1) % 3] to p[edge], as its corners `turn` and `turn` + 1 (modulo 3), and adds the
/// third corner. Code 9 shares nothing and adds all three. Larger codes are corrupt.
struct StripStep {
  static constexpr std::uint32_t kBits = 4;
  static constexpr std::uint32_t kApart = 9;

  [[nodiscard]] static constexpr std::uint32_t code(std::uint32_t edge,
                                                    std::uint32_t turn) noexcept {
    return 3 * edge + turn;
  }
};

/// The grid geometry of one tree, as stored in the file.
struct GridView {
  const std::byte* clusters = nullptr;  // ClusterRecord each
  Bytes bytes;                          // of all clusters, and kClusterPadding
  std::uint32_t face_count = 0;
  std::uint32_t corners_per_face = 3;
};

/// Most vertices of a leaf: every face is a quad and shares none.
inline constexpr std::size_t kMaxLeafVertices = std::size_t{4} * kLeafFaces;

/// A decoded leaf. Corrupt bytes may give any positions.
struct GridLeaf {
  static constexpr std::uint8_t kNoCorner = 0xff;

  std::uint32_t vertex_count = 0;
  std::uint32_t face_count = 0;
  std::array<std::array<std::int32_t, 4>, kMaxLeafVertices> position;  // grid coordinates and a 0
  std::array<std::array<std::uint8_t, 4>, kLeafFaces> corner;          // indices into `position`
};

/// Decodes leaf `leaf`: faces 8 leaf to 8 leaf + 7, or up to the last. False when its bytes are
/// corrupt. Reads nothing outside `grid`, whatever the bytes. Precondition: the leaf exists, and
/// `clusters` has clusters_of(face_count) records.
[[nodiscard]] bool decode_grid_leaf(const GridView& grid, std::uint32_t leaf,
                                    GridLeaf& out) noexcept;

}  // namespace boxtree
