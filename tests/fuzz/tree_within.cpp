// SPDX-License-Identifier: MIT
// Whether the tree of any file touches itself in another pose, as far as it matters.
#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  query_tree(input, [](const Tree& tree, const QueryInput& query, const auto& check) {
    const std::uint64_t budget = query.option(2) == 0 ? kUnlimitedNodes : query.option(2);
    check(overlap_within(tree, Pose::Identity(), tree, query.pose(), query.number(0), budget));
  });
}

}  // namespace boxtree::fuzz
