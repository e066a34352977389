// SPDX-License-Identifier: MIT
// Rays and segments against the tree of any file.
#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  query_tree(input, [](const Tree& tree, const Question& question, const auto& check) {
    Ray ray{question.vector(0), question.vector(3)};
    if (question.option(1) % 2 == 1) ray.t_min = question.number(6);
    if (question.option(1) % 4 >= 2) ray.t_max = question.number(7);
    const auto closest = closest_hit(tree, ray, question.limits());
    const auto any = any_hit(tree, ray, question.limits());
    check(closest);
    check(any);
    // Nothing is missed: both know whether there is a hit.
    if (closest.ok() && any.ok() && closest.has_value() != any.has_value()) {
      finding("closest_hit and any_hit differ");
    }
  });
}

}  // namespace boxtree::fuzz
