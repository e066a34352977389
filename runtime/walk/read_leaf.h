// SPDX-License-Identifier: MIT
// The exact triangles of a whole leaf, for the walks that need all of them.
#pragma once

#include <boxtree/error.h>

#include "format/children.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree {

/// LeafReader::read, by vectors where the build and the machine have them: the same triangles, and
/// the same errors.
[[nodiscard]] Errc read_leaf(const BoundTree& tree, NodeRef leaf, TriangleBatch& out) noexcept;

/// A full leaf of a cluster in a third of the instructions, where the machine has AVX2. False where
/// LeafReader has to read it. Precondition: the tree has clusters whose leaves are scaled as they
/// are stored (FloatLeaves::is_direct), and `leaf` is one of them.
[[nodiscard]] bool read_leaf_wide(const BoundTree& tree, NodeRef leaf, TriangleBatch& out) noexcept;

}  // namespace boxtree
