// SPDX-License-Identifier: MIT
// Full leaves of clusters without vectors, for walks by vectors that are shorter than eight
// numbers, where a build has no longer ones. The same numbers as decode_cluster_leaf
// (format/cluster.cpp), which decodes any leaf and checks everything, in half of the
// instructions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "format/cluster.h"
#include "format/cluster_leaf.h"
#include "runtime/tree/frame.h"
#include "runtime/tree/leaf_fields.h"

namespace boxtree {

/// What the vertices of a group have in common, of numbers of 32 bits.
struct PlainGroup {
  std::array<std::uint32_t, 3> mask;  // the bits of an offset
  std::array<std::uint32_t, 3> base;
  std::uint32_t bit;                  // of the cluster, where the first vertex begins
  std::uint16_t stride;               // bits of a vertex
  std::array<std::uint8_t, 2> width;  // of x and y
};

/// The cluster that was read last (LeafTable::cluster), so that its other leaves need not find it
/// again.
struct PlainCluster {
  PlainCluster() noexcept;  // not inlined, for the size of each walk

  LeafTable leaves;
  ClusterGroups groups;
  std::array<PlainGroup, ClusterHeader::kMostGroups> group;
  std::uint32_t known = 0;  // bit g: group[g] is set
  std::uint32_t group_count = 0;
  std::uint32_t vertices_at = 0;     // byte
  const std::byte* bases = nullptr;  // a byte for each group, an axis after the other
};

/// Reads leaves of one tree, one at a time: what ClusterReader (walk/cluster-inl.h) is where
/// vectors have eight numbers.
class PlainClusterReader {
 public:
  /// `frame`, `doubles`: of numbers of 64 bits, whose positions go there.
  PlainClusterReader(const ClusterView& clusters, const Frame& frame,
                     DoublePositions& doubles) noexcept
      : clusters_(clusters), frame_(frame), doubles_(doubles) {}

  /// Decodes a leaf of 8 faces; coordinates are multiplied by `scale`, or those of 64 bits placed
  /// in tree space and rounded. Corners of leaves without quads are those of the source but for a
  /// turn, which LeafTriangles::read_corners() undoes. False when its bytes are corrupt, or when
  /// decode_cluster_leaf has to read it. Preconditions: the leaf exists and has 8 faces, and there
  /// are cluster_table_bytes.
  [[nodiscard]] bool read(std::uint32_t leaf, float scale, LeafTriangles& triangles,
                          LeafCoordinates& out) noexcept;

 private:
  const ClusterView& clusters_;
  const Frame& frame_;
  DoublePositions& doubles_;
  PlainCluster found_;
};

}  // namespace boxtree
