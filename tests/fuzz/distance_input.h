// SPDX-License-Identifier: MIT
// Distances of a fuzzed query: exact or as nearly as some of its numbers say.
#pragma once

#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {

inline DistanceOptions distance_options(const QueryInput& query) {
  DistanceOptions options;
  if (query.option(1) % 2 == 1) options.relative_error = query.number(0);
  if (query.option(1) % 4 >= 2) options.absolute_error = query.number(1);
  if (query.option(1) % 8 >= 4) options.max_distance = query.number(2);
  if (query.option(2) != 0) options.node_budget = query.option(2);
  return options;
}

template <class AnyDistance>
void check_distance(const Result<AnyDistance>& found) {
  if (found && !(found->lower <= found->upper)) finding("bounds of a distance cross");
}

}  // namespace boxtree::fuzz
