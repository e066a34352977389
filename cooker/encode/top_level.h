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

/// Deterministic. `world_boxes`: the boxes of the static instances, as in PlacementBounds::world.
/// Each instance is a leaf: a leaf costs a query a whole tree, so its box must be tight.
/// `moving_boxes`: the boxes of moving instances; they are in no leaf, but define the frame if
/// nothing is static. Precondition: at most kMaxInstances boxes, finite.
[[nodiscard]] EncodedTopLevel build_top_level(std::span<const Box<double>> world_boxes,
                                              std::span<const Box<double>> moving_boxes);

}  // namespace boxtree::cooker
