// SPDX-License-Identifier: MIT
// Pair queries for callers that have set the floating-point state and share a limit.
#pragma once

#include <boxtree/contact.h>

#include "runtime/tree/bound_tree.h"
#include "runtime/walk/work.h"

namespace boxtree {

/// overlap_pairs as a part of a larger query.
Result<Visit> visit_pairs(const BoundTree& first, const Pose& first_pose, const BoundTree& second,
                          const Pose& second_pose, PairVisitor visitor, QueryWork& work);
/// pair_contacts likewise.
Result<Visit> visit_pair_contacts(const BoundTree& first, const Pose& first_pose,
                                  const BoundTree& second, const Pose& second_pose,
                                  PairContactVisitor visitor, QueryWork& work);

}  // namespace boxtree
