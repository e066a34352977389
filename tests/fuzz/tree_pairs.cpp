// SPDX-License-Identifier: MIT
// The tree of any file against itself, the second one in any pose.
#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  query_tree(input, [](const Tree& tree, const QueryInput& query, const auto& check) {
    std::uint64_t pairs = 0;
    const auto all = overlap_pairs(
        tree, Pose::Identity(), tree, query.pose(),
        [&pairs](const FacePair&) { return ++pairs != 0; }, query.limits());
    check(all);
    const auto first = first_contact(tree, Pose::Identity(), tree, query.pose(), query.limits());
    check(first);
    if (all.ok() && first.ok() && first.has_value() != (pairs != 0)) {
      finding("overlap_pairs and first_contact differ");
    }
  });
}

}  // namespace boxtree::fuzz
