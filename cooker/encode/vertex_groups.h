// SPDX-License-Identifier: MIT
// The groups in which a cluster stores its vertices (format/cluster.h) in the fewest bits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace boxtree::cooker {

/// What a group has of its own, for x, y and z.
struct VertexGroup {
  std::array<std::uint64_t, 3> base;   // in units of 2^base_shift
  std::array<std::uint32_t, 3> width;  // of its vertices' offsets

  [[nodiscard]] std::uint32_t stride() const { return width[0] + width[1] + width[2]; }
};

struct VertexGroups {
  std::uint32_t size = 0;                    // vertices of each but the last
  std::array<std::uint8_t, 3> base_shift{};  // see ClusterHeader
  std::array<std::uint8_t, 3> narrowest{};   // of their widths
  std::vector<VertexGroup> group;
};

/// Chooses them for vertices in the order in which they are stored. `offset`: theirs from the low
/// corner of their cluster. Precondition: 1 vertex to 4 kClusterFaces.
[[nodiscard]] VertexGroups best_groups(std::span<const std::array<std::uint64_t, 3>> offset);

}  // namespace boxtree::cooker
