// SPDX-License-Identifier: MIT
// Distance queries for callers that have set the floating-point state.
#pragma once

#include <boxtree/distance.h>

#include "runtime/tree/bound_tree.h"

namespace boxtree {

/// distance() as a part of a larger query. Precondition: `options` are valid.
Result<Distance> distance_of_trees(const BoundTree& first, const Pose& first_pose,
                                   const BoundTree& second, const Pose& second_pose,
                                   const DistanceOptions& options);

}  // namespace boxtree
