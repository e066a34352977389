// SPDX-License-Identifier: MIT
// Closest points on the tree of any file, exact and approximate.
#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  query_tree(input, [](const Tree& tree, const QueryInput& query, const auto& check) {
    const Eigen::Vector3d point = query.vector(0);
    if (query.option(1) % 2 == 0) {
      const double max_distance =
          query.option(1) % 4 == 2 ? query.number(3) : std::numeric_limits<double>::infinity();
      check(closest_point(tree, point, max_distance, query.limits()));
      return;
    }
    PointOptions options;
    options.relative_error = query.number(3);
    options.absolute_error = query.number(4);
    if (query.option(1) % 4 == 3) options.max_distance = query.number(5);
    if (query.option(2) != 0) options.node_budget = query.option(2);
    const auto found = closest_point(tree, point, options);
    check(found);
    if (found && !(found->lower <= found->upper)) finding("bounds of a distance cross");
  });
}

}  // namespace boxtree::fuzz
