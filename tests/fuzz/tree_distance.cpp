// SPDX-License-Identifier: MIT
// The distance of the tree of any file from itself in another pose, exact and approximate.
#include "tests/fuzz/distance_input.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  query_tree(input, [](const Tree& tree, const QueryInput& query, const auto& check) {
    const auto found =
        distance(tree, Pose::Identity(), tree, query.pose(), distance_options(query));
    check(found);
    check_distance(found);
  });
}

}  // namespace boxtree::fuzz
