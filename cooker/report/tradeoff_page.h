// SPDX-License-Identifier: MIT
// A tradeoff report as a page for readers new to the project.
#pragma once

#include "cooker/report/page.h"
#include "cooker/report/tradeoff_data.h"

namespace boxtree::cooker {

[[nodiscard]] Page tradeoff_page(const TradeoffReport& report);

/// Only the first part of the page: the recommendation for each mesh.
[[nodiscard]] Page tradeoff_summary(const TradeoffReport& report);

}  // namespace boxtree::cooker
