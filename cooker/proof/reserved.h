// SPDX-License-Identifier: MIT
// Bytes inside a tree's sections that mean nothing and that writers leave zero. Queries pass over
// them; `boxtree verify` does not, so that a later version of the format may give them a meaning.
#pragma once

#include "cooker/proof/proof.h"

namespace boxtree::cooker {

/// What is set in the sections of a tree although docs/FORMAT.md says "zero":
/// kPaddingNotZero, kMaxFindings at most. O(bytes). Precondition: tree `index` has been bound.
[[nodiscard]] Findings check_reserved(const File& file, std::uint32_t index);

}  // namespace boxtree::cooker
