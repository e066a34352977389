// SPDX-License-Identifier: MIT
// Rays and segments against the tree of any file.
#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  query_tree(input, [](const Tree& tree, const QueryInput& query, const auto& check) {
    Ray ray{query.vector(0), query.vector(3)};
    if (query.option(1) % 2 == 1) ray.t_min = query.number(6);
    if (query.option(1) % 4 >= 2) ray.t_max = query.number(7);
    const auto closest = closest_hit(tree, ray, query.limits());
    const auto any = any_hit(tree, ray, query.limits());
    check(closest);
    check(any);
    if (closest.ok() && closest.has_value()) {
      static_cast<void>(tree.material_name(tree.material(closest->face)));
      static_cast<void>(tree.user_data(closest->face));
    }
    // Nothing is missed: both know whether there is a hit.
    if (closest.ok() && any.ok() && closest.has_value() != any.has_value()) {
      finding("closest_hit and any_hit differ");
    }
  });
}

}  // namespace boxtree::fuzz
