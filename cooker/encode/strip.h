// SPDX-License-Identifier: MIT
// The faces of a leaf of a cluster as a strip: each follows from the one before over an edge that
// both share, where there is one (StripStep in format/cluster.h).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "format/cluster.h"

namespace boxtree::cooker {

/// A face by the indices of its vertices in the cluster.
struct ClusterFace {
  std::array<std::uint16_t, 4> corner;
  std::uint32_t source;
  bool is_quad;
};

/// A step of a strip from one face to the next, and the corner that it adds.
struct Step {
  std::uint32_t code = StripStep::kApart;
  std::uint32_t turn = 0;  // the edge by which the next face is entered

  [[nodiscard]] bool is_apart() const { return code == StripStep::kApart; }
  [[nodiscard]] std::uint32_t brings() const { return (turn + 2) % 3; }
};

/// The step from a face that is entered by edge `entered`.
[[nodiscard]] Step step_between(const ClusterFace& from, std::uint32_t entered,
                                const ClusterFace& to);

/// Orders the faces of a leaf so that many share an edge with the previous one. Deterministic.
/// Precondition: at most kLeafFaces of them.
void order_as_strip(std::span<ClusterFace> faces);

}  // namespace boxtree::cooker
