// SPDX-License-Identifier: MIT
// A tradeoff report as a page that a newcomer can read from the top.
#pragma once

#include "cooker/report/page.h"
#include "cooker/report/tradeoff_data.h"

namespace boxtree::cooker {

[[nodiscard]] Page tradeoff_page(const TradeoffReport& report);

/// The page's first words alone: what to use for each mesh.
[[nodiscard]] Page tradeoff_summary(const TradeoffReport& report);

}  // namespace boxtree::cooker
