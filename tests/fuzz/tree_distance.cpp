// SPDX-License-Identifier: MIT
// The distance of the tree of any file from itself in another pose, exact and approximate.
#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  query_tree(input, [](const Tree& tree, const QueryInput& query, const auto& check) {
    DistanceOptions options;
    if (query.option(1) % 2 == 1) options.relative_error = query.number(0);
    if (query.option(1) % 4 >= 2) options.absolute_error = query.number(1);
    if (query.option(1) % 8 >= 4) options.max_distance = query.number(2);
    if (query.option(2) != 0) options.node_budget = query.option(2);
    const auto found = distance(tree, Pose::Identity(), tree, query.pose(), options);
    check(found);
    if (found && !(found->lower <= found->upper)) finding("bounds of a distance cross");
  });
}

}  // namespace boxtree::fuzz
