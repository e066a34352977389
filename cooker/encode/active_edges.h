// SPDX-License-Identifier: MIT
// Section active_edges (reader: format/active_edges.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <boxtree/tree.h>

#include "cooker/build/active_edges.h"

namespace boxtree::cooker {

/// The section of a tree, whose face i is face order[i] of the mesh. Where several edges have the
/// same ends in the tree, as on a grid, they are active if one is. Precondition: the tree has
/// faces. Errors: those of reading its leaves; kMeshTooLarge for more than 2^31 edges with bits.
Result<std::vector<std::byte>> encode_active_edges(const Tree& tree,
                                                   std::span<const std::uint32_t> order,
                                                   const ActiveEdges& edges);

}  // namespace boxtree::cooker
