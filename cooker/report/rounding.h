// SPDX-License-Identifier: MIT
// Measures the effect of rounding f16 cuts to nearest instead of outward on contacts (paper section
// 2.5 does not specify the rounding). Only reports build such trees.
#pragma once

#include <cstdint>
#include <vector>

#include <boxtree/error.h>

#include "cooker/proof/gates.h"

namespace boxtree::cooker {

/// The contacts found on three trees of one mesh.
struct RoundingFigures {
  std::uint64_t queries = 0;
  std::uint64_t pairs_f32 = 0;      // pairs of faces found with f32 cuts
  std::uint64_t pairs_nearest = 0;  // with f16 cuts rounded to nearest
  std::uint64_t pairs_outward = 0;  // with f16 cuts rounded outward: codec plain-f16
  Gates gates_nearest;              // gates of the nearest tree
  Gates gates_outward;
};

/// `f32` is a tree in codec plain-f32; the nearest tree is made from its nodes. The mesh meets its
/// copy turned by each of the 24 rotations that map axes to axes. Faces of the bounding boxes touch
/// or overlap by up to 1e-4 of the longest edge: aligned contact, as of parts on floors.
Result<RoundingFigures> aligned_contact(const SourceMesh& mesh, const EncodedTree& f32,
                                        const EncodedTree& outward);

/// A box resting on each of 64 steps of a stair 8 units long.
struct StairFigures {
  double depth = 0;  // of the box below the step
  std::uint64_t steps = 0;
  std::uint64_t missed_f32 = 0;
  std::uint64_t missed_nearest = 0;
  std::uint64_t missed_outward = 0;
};
Result<std::vector<StairFigures>> stair_contact();

}  // namespace boxtree::cooker
