// SPDX-License-Identifier: MIT
// The tree of any file against itself, the second one in any pose: pairs, and where they touch.
#include "tests/fuzz/answers.h"
#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  query_tree(input, [](const Tree& tree, const QueryInput& query, const auto& check) {
    Pose first_pose = Pose::Identity();
    if (query.option(1) % 2 == 1) first_pose.translation() = query.vector(6);
    std::uint64_t pairs = 0;
    const auto all = overlap_pairs(
        tree, first_pose, tree, query.pose(), [&pairs](const FacePair&) { return ++pairs != 0; },
        query.limits());
    check(all);
    const auto first = first_contact(tree, first_pose, tree, query.pose(), query.limits());
    check(first);
    if (all.ok() && first.ok() && first.has_value() != (pairs != 0)) {
      finding("overlap_pairs and first_contact differ");
    }
    std::uint64_t touches = 0;
    const auto touching = pair_contacts(
        tree, first_pose, tree, query.pose(),
        [&](const PairContact& contact) {
          check_contact(contact, check);
          return ++touches != 0;
        },
        query.limits());
    check(touching);
    if (all.ok() && touching.ok() && (touches != 0) != (pairs != 0)) {
      finding("overlap_pairs and pair_contacts differ");
    }
  });
}

}  // namespace boxtree::fuzz
