// SPDX-License-Identifier: MIT
// Bytes inside nodes and clusters that mean nothing and that writers leave zero. Queries pass over
// them; `boxtree verify` does not, so that a later version of the format may give them a meaning.
#pragma once

#include "cooker/proof/proof.h"
#include "format/tree_record.h"

namespace boxtree::cooker {

/// What is set in nodes and clusters of a tree although docs/FORMAT.md says "zero":
/// kPaddingNotZero, kMaxFindings at most. O(bytes). `nodes`, `vertices` and `corners` are the
/// tree's sections.
[[nodiscard]] Findings check_reserved(const TreeRecord& record, Bytes nodes, Bytes vertices,
                                      Bytes corners);

}  // namespace boxtree::cooker
