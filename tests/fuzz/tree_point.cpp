// SPDX-License-Identifier: MIT
// Closest points on the tree of any file, exact and approximate.
#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  query_tree(input, [](const Tree& tree, const Question& question, const auto& check) {
    const Eigen::Vector3d point = question.vector(0);
    if (question.option(1) % 2 == 0) {
      const double reach = question.option(1) % 4 == 2 ? question.number(3)
                                                       : std::numeric_limits<double>::infinity();
      check(closest_point(tree, point, reach, question.limits()));
      return;
    }
    PointOptions options;
    options.relative_error = question.number(3);
    options.absolute_error = question.number(4);
    if (question.option(1) % 4 == 3) options.max_distance = question.number(5);
    if (question.option(2) != 0) options.node_budget = question.option(2);
    const auto found = closest_point(tree, point, options);
    check(found);
    if (found && !(found->lower <= found->upper)) finding("bounds of a distance cross");
  });
}

}  // namespace boxtree::fuzz
