// SPDX-License-Identifier: MIT
// Curves of time, nodes and error over the allowed error or budget.
#pragma once

#include <vector>

#include "cooker/report/page.h"
#include "cooker/report/tradeoff.h"

namespace boxtree::cooker {

/// One section for closest points and one for distances; none if no encoding was queried.
[[nodiscard]] std::vector<PageSection> approximate_sections(const MeshTradeoff& mesh);

}  // namespace boxtree::cooker
