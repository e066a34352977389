// SPDX-License-Identifier: MIT
// Spheres against the tree of any file.
#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  query_tree(input, [](const Tree& tree, const QueryInput& query, const auto& check) {
    const std::uint32_t most = query.option(1) == 0 ? ~0u : query.option(1);
    std::uint32_t faces = 0;
    check(overlap_sphere(
        tree, query.vector(0), query.number(3), [&](const FaceRef&) { return ++faces < most; },
        query.limits()));
  });
}

}  // namespace boxtree::fuzz
