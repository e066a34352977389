// SPDX-License-Identifier: MIT
// Whether the tree of any file touches itself in another pose, as far as it matters.
#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  query_tree(input, [](const Tree& tree, const Question& question, const auto& check) {
    const std::uint64_t budget = question.option(2) == 0 ? kUnlimitedNodes : question.option(2);
    check(
        overlap_within(tree, Pose::Identity(), tree, question.pose(), question.number(0), budget));
  });
}

}  // namespace boxtree::fuzz
