// SPDX-License-Identifier: MIT
// Checks reserved bytes inside a tree's sections, which writers set to zero. Queries ignore them;
// `boxtree verify` checks them, so that a later version of the format may use them.
#pragma once

#include "cooker/proof/proof.h"

namespace boxtree::cooker {

/// Reserved bits (docs/FORMAT.md: "zero") that are set in the sections of a tree: kPaddingNotZero,
/// at most kMaxFindings. O(bytes). Precondition: tree `index` has been bound.
[[nodiscard]] Findings check_reserved(const File& file, std::uint32_t index);

}  // namespace boxtree::cooker
