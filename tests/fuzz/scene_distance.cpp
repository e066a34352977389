// SPDX-License-Identifier: MIT
// Distances in the scene of any file: of a tree that is no part of it, of one instance; exact and
// approximate.
#include "tests/fuzz/distance_input.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  query_scene(input, [](const Scene& scene, const QueryInput& query, const auto& check) {
    const DistanceOptions options = distance_options(query);
    const bool is_of_instance = query.option(1) % 16 >= 8 || scene.trees().empty();
    const auto found = is_of_instance
                           ? distance_of(scene, query.option(3), options)
                           : distance(scene, scene.trees()[0], query.pose(), kAllLayers, options);
    check(found);
    check_distance(found);
  });
}

}  // namespace boxtree::fuzz
