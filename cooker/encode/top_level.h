// SPDX-License-Identifier: MIT
// The tree over the static instances of a scene, built by surface area and stored as wide8.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "cooker/encode/encoded.h"
#include "format/box.h"

namespace boxtree::cooker {

struct EncodedTopLevel {
  std::array<double, 3> origin{};  // of the frame, world
  int scale_exponent = 0;
  EncodedNodes nodes;
  std::vector<std::uint32_t> order;  // instance of each leaf, as numbers in the span given
};

/// Deterministic. `world_boxes`: of the instances, as PlacementBounds::world gives them. An
/// instance is a leaf of its own: what a leaf costs a query is a whole tree, so boxes are as tight
/// as they can be. `moving_boxes`: of those that move; they are in no leaf, but set the frame where
/// nothing is static. Precondition: at most kMaxInstances boxes, finite.
[[nodiscard]] EncodedTopLevel build_top_level(std::span<const Box<double>> world_boxes,
                                              std::span<const Box<double>> moving_boxes);

}  // namespace boxtree::cooker
