// SPDX-License-Identifier: MIT
// Batches of rays.
#include "runtime/primitive/float_state.h"
#include "runtime/query/invalid_query.h"
#include "runtime/query/ray_batch_query.h"
#include "runtime/walk/walk_tree.h"

namespace boxtree {

void RayBatch::answer(std::size_t i, RayTest& test) {
  test.finish(rays[i]);
  if (test.hit.is_hit) {
    results[i] = described(tree, test.hit);
  } else {
    answer_nothing(i);
  }
}

namespace {

Status answer(const Tree& queried, std::span<const Ray> rays, std::span<RayResult> results,
              bool any, const QueryLimits& limits) {
  if (results.size() != rays.size()) return invalid_query("results");
  if constexpr (kHasWideCodecs && kWalksByVectors) {
    const BoundTree& tree = BoundTree::of(queried);
    const bool is_limited = limits.nodes != QueryLimits().nodes;
    if (!is_limited && has_wide_nodes(tree) && tree.has_float_nodes()) {
      const DefaultFloatState state;
      RayBatch batch{queried, tree, rays, results, any};
      walk_wide(batch);
      return {};
    }
  }
  for (std::size_t i = 0; i < rays.size(); ++i) {
    results[i] = any ? any_hit(queried, rays[i], limits) : closest_hit(queried, rays[i], limits);
  }
  return {};
}

}  // namespace

Status closest_hits(const Tree& tree, std::span<const Ray> rays, std::span<RayResult> results,
                    const QueryLimits& limits) {
  return answer(tree, rays, results, false, limits);
}

Status any_hits(const Tree& tree, std::span<const Ray> rays, std::span<RayResult> results,
                const QueryLimits& limits) {
  return answer(tree, rays, results, true, limits);
}

}  // namespace boxtree
