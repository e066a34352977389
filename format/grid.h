// SPDX-License-Identifier: MIT
// Geometry store "grid": corners on a grid of whole numbers, in clusters of 16 leaves of 8 faces.
// A cluster holds each of its vertices once, as an offset from its own origin in as many bits as
// the cluster is large; a leaf is a strip of faces over them and can be decoded alone. A vertex has
// the same whole numbers in every cluster that it is in, so that no gap opens between them.
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

/// Clusters start at multiples of so many bytes: 32 bits then reach all faces that a tree can have.
inline constexpr std::uint64_t kClusterUnit = 4;

/// Bits of a grid over the largest extent: what writers offer and readers may rely on.
inline constexpr int kMinGridBits = 8;
inline constexpr int kMaxGridBits = 30;

/// Zero bytes after the last cluster: the longest leaf (see docs/FORMAT.md) and the width of a
/// reader of bits, so that reading one needs no check at every field.
inline constexpr std::size_t kClusterPadding = 96;

/// Where a cluster lies and how wide its fields are. Faces of cluster n: 128 n to 128 n + 127. Its
/// bytes: a field of leaf_bits for each leaf and one more; the leaves, each from a whole byte on;
/// the offsets of its vertices. Leaf i starts i * leaf_bytes plus its field after these fields, and
/// the offsets of vertices as one more leaf would, so that any leaf is found at once.
struct ClusterRecord {
  std::array<std::int32_t, 3> origin;  // grid coordinates of the low corner
  std::uint32_t offset;  // of its bytes in the section, in units of kClusterUnit bytes
  std::uint16_t vertex_count;
  std::array<std::uint8_t, 3> width;  // bits of a vertex's offset on each axis, at most 32
  std::uint8_t leaf_bytes;            // least mean length of leaves from the first one on
  std::uint8_t leaf_bits;             // at most 16
  std::uint8_t reserved;              // zero
};
static_assert(sizeof(ClusterRecord) == 24 && std::is_trivially_copyable_v<ClusterRecord>);
static_assert(offsetof(ClusterRecord, width) == 18 && offsetof(ClusterRecord, leaf_bits) == 22);

[[nodiscard]] constexpr std::uint32_t clusters_of(std::uint32_t faces) noexcept {
  return faces / kClusterFaces + (faces % kClusterFaces != 0 ? 1 : 0);
}

/// How a face of a strip follows from the one before, whose corners are p: it shares the edge from
/// p[(edge + 1) % 3] to p[edge], which are its corners `turn` and `turn` + 1 (modulo 3), and brings
/// the third. Code 9 shares nothing and brings all three. Larger codes are corrupt.
struct StripStep {
  static constexpr std::uint32_t kBits = 4;
  static constexpr std::uint32_t kApart = 9;

  [[nodiscard]] static constexpr std::uint32_t code(std::uint32_t edge,
                                                    std::uint32_t turn) noexcept {
    return 3 * edge + turn;
  }
};

/// The grid geometry of one tree, as it lies in the file.
struct GridView {
  const std::byte* clusters = nullptr;  // ClusterRecord each
  Bytes bytes;                          // of all clusters, and kClusterPadding
  std::uint32_t face_count = 0;
  std::uint32_t corners_per_face = 3;
};

/// Most vertices that a leaf can have: every face a quad for itself.
inline constexpr std::size_t kMaxLeafVertices = std::size_t{4} * kLeafFaces;

/// A decoded leaf. Positions of corrupt bytes may be any numbers.
struct GridLeaf {
  static constexpr std::uint8_t kNoCorner = 0xff;

  std::uint32_t vertex_count = 0;
  std::uint32_t face_count = 0;
  std::array<std::array<std::int32_t, 4>, kMaxLeafVertices> position;  // grid coordinates and a 0
  std::array<std::array<std::uint8_t, 4>, kLeafFaces> corner;          // numbers of these vertices
};

/// Decodes leaf `leaf`: faces 8 leaf to 8 leaf + 7, or up to the last. False when its bytes are
/// corrupt; whatever they are, nothing outside `grid` is read. Precondition: the leaf is there, and
/// `clusters` has clusters_of(face_count) records.
[[nodiscard]] bool decode_grid_leaf(const GridView& grid, std::uint32_t leaf,
                                    GridLeaf& out) noexcept;

}  // namespace boxtree
