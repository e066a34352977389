// SPDX-License-Identifier: MIT
// A pair of leaves that are near each other, with which the search for the distance of two trees
// begins: the nearer its first pair, the fewer others it has to look at.
#pragma once

#include <optional>

#include <boxtree/query.h>

#include "format/children.h"
#include "runtime/query/relative_pose.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree {

/// A leaf of each tree, or as many faces in a row as a leaf has.
struct NearbyLeaves {
  NodeRef first;
  NodeRef second;
};

/// Goes back and forth between the trees, from a point of one to the closest of the other. Nothing
/// where that finds none, or where bytes are corrupt. Visits a number of nodes that does not depend
/// on the trees; the same on every machine. Precondition: neither tree is empty.
[[nodiscard]] std::optional<NearbyLeaves> nearby_leaves(const BoundTree& first,
                                                        const BoundTree& second,
                                                        const RelativePose& pose) noexcept;

}  // namespace boxtree
