// SPDX-License-Identifier: MIT
// The ids of the faces of a leaf, for answers that name many faces.
#pragma once

#include <cstdint>
#include <span>

#include "format/face_ids.h"
#include "format/limits.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree {

/// BoundTree::read_leaf_ids, by vectors where the build and the machine have them.
void read_leaf_ids(const BoundTree& tree, std::uint32_t leaf,
                   std::span<std::uint32_t, kLeafFaces> out) noexcept;

/// FaceIdView::read_leaf in half of its instructions, where the machine has AVX2.
void read_leaf_ids_wide(const FaceIdView& ids, std::uint32_t leaf,
                        std::span<std::uint32_t, kLeafFaces> out) noexcept;

}  // namespace boxtree
