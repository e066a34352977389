// SPDX-License-Identifier: MIT
// The distance of the tree of any file from itself in another pose, exact and approximate.
#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  query_tree(input, [](const Tree& tree, const Question& question, const auto& check) {
    DistanceOptions options;
    if (question.option(1) % 2 == 1) options.relative_error = question.number(0);
    if (question.option(1) % 4 >= 2) options.absolute_error = question.number(1);
    if (question.option(1) % 8 >= 4) options.max_distance = question.number(2);
    if (question.option(2) != 0) options.node_budget = question.option(2);
    const auto found = distance(tree, Pose::Identity(), tree, question.pose(), options);
    check(found);
    if (found && !(found->lower <= found->upper)) finding("bounds of a distance cross");
  });
}

}  // namespace boxtree::fuzz
