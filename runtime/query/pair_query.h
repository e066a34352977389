// SPDX-License-Identifier: MIT
// Pair queries for callers that have seen to the floating-point state and share a limit.
#pragma once

#include <boxtree/contact.h>

namespace boxtree {

/// overlap_pairs as a part of a larger query.
Result<Visit> visit_pairs(const Tree& first, const Pose& first_pose, const Tree& second,
                          const Pose& second_pose, PairVisitor visitor, QueryWork& work);

}  // namespace boxtree
