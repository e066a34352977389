// SPDX-License-Identifier: MIT
// Frustums against the tree of any file.
#include "tests/fuzz/frustum_input.h"
#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  query_tree(input, [](const Tree& tree, const QueryInput& query, const auto& check) {
    const std::uint32_t most = query.option(3) == 0 ? ~0u : query.option(3);
    std::uint32_t faces = 0;
    const auto visit = overlap_frustum(
        tree, frustum_of(query), [&](const FaceRef&) { return ++faces < most; }, query.limits());
    check(visit);
    // Twice the planes are the same frustum.
    Frustum twice = frustum_of(query);
    for (Frustum::Plane& plane : twice.planes) plane *= 2;
    std::uint32_t faces_of_twice = 0;
    const auto visit_twice = overlap_frustum(
        tree, twice, [&](const FaceRef&) { return ++faces_of_twice < most; }, query.limits());
    check(visit_twice);
    if (visit.ok() && visit_twice.ok() && faces != faces_of_twice) {
      finding("planes of another length hold other faces");
    }
  });
}

}  // namespace boxtree::fuzz
