// SPDX-License-Identifier: MIT
// Decodes leaves of clusters by AVX-512: 16 references at once, in half the instructions of
// cluster-inl.h, whose walks call it where the machine has it. Walks themselves gain little by
// AVX-512, so this alone is compiled for it.
#pragma once

#include <cstdint>

#include "format/cluster.h"
#include "runtime/tree/leaf_fields.h"

namespace boxtree {

/// The cluster that was read last. A lane is a group, and a row what all vertices of that group
/// have in common.
struct Avx512Cluster {
  using Lanes = std::uint32_t[ClusterHeader::kMostGroups];

  explicit Avx512Cluster(const ClusterView& view) noexcept : leaves(view) {}

  LeafTable leaves;
  bool is_long = false;  // offsets of z may begin after the first 64 bits
  std::uint32_t trailing[3];
  alignas(64) Lanes start;        // byte of the cluster
  alignas(64) Lanes stride;       // bits of a vertex
  alignas(64) Lanes at[2];        // bits before the offsets of y and z
  alignas(64) Lanes low_bits[3];  // those of an offset
  alignas(64) Lanes base[3];
  alignas(64) Lanes byte;  // where the vertices of the last leaf are: written, then read
};

/// Decodes leaf `leaf` as ClusterReader::read does; false where that does not read it either.
using Avx512LeafReader = bool (*)(const ClusterView& view, std::uint32_t leaf, float scale,
                                  Avx512Cluster& cluster, LeafTriangles& triangles,
                                  LeafCoordinates& out);

/// Null where the machine, the build or Highway's choice of targets has no AVX-512 with VBMI2.
[[nodiscard]] Avx512LeafReader avx512_leaf_reader() noexcept;

}  // namespace boxtree
