// SPDX-License-Identifier: MIT
// Spheres against the tree of any file, and those of batches.
#include "tests/fuzz/overlap_batch.h"
#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  query_tree(input, [](const Tree& tree, const QueryInput& query, const auto& check) {
    const std::uint32_t most = query.option(1) == 0 ? ~0u : query.option(1);
    std::uint32_t faces = 0;
    check(overlap_sphere(
        tree, query.vector(0), query.number(3), [&](const FaceRef&) { return ++faces < most; },
        query.limits()));
    if (query.option(1) % 4 == 0) {
      visit_many(
          query, check,
          [&](const Eigen::Vector3d& offset) {
            return Sphere{query.vector(0) + offset, query.number(3)};
          },
          [&](auto shapes, auto results, auto visitor, const QueryLimits& limits) {
            return overlap_spheres(tree, shapes, results, visitor, limits);
          },
          [&](const Sphere& sphere, auto visitor, const QueryLimits& limits) {
            return overlap_sphere(tree, sphere, visitor, limits);
          });
    }
  });
}

}  // namespace boxtree::fuzz
