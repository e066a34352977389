// SPDX-License-Identifier: MIT
// Distances in the scene of any file: of a tree that is no part of it, of one instance; exact and
// approximate.
#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  query_scene(input, [](const Scene& scene, const QueryInput& query, const auto& check) {
    DistanceOptions options;
    if (query.option(1) % 2 == 1) options.relative_error = query.number(0);
    if (query.option(1) % 4 >= 2) options.absolute_error = query.number(1);
    if (query.option(1) % 8 >= 4) options.max_distance = query.number(2);
    if (query.option(2) != 0) options.node_budget = query.option(2);
    const bool is_of_instance = query.option(1) % 16 >= 8 || scene.trees().empty();
    const auto found = is_of_instance
                           ? distance_of(scene, query.option(3), options)
                           : distance(scene, scene.trees()[0], query.pose(), kAllLayers, options);
    check(found);
    if (found && !(found->lower <= found->upper)) finding("bounds of a distance cross");
  });
}

}  // namespace boxtree::fuzz
