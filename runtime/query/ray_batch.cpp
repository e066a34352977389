// SPDX-License-Identifier: MIT
// Batches of rays.
#include "runtime/query/invalid_query.h"
#include "runtime/query/ray_batch_query.h"
#include "runtime/walk/packets.h"

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

Status answer_all(const Tree& tree, std::span<const Ray> rays, std::span<RayResult> results,
                  bool any, const QueryLimits& limits, RayWishes* wishes,
                  FunctionRef<RayResult(const Ray&)> alone) {
  if (results.size() != rays.size()) return invalid_query("results.size()");
  RayBatch batch{BoundTree::of(tree), rays, results, any, wishes, alone};
  answer_batch(batch, limits);
  return {};
}

}  // namespace

Status closest_hits(const Tree& tree, std::span<const Ray> rays, std::span<RayResult> results,
                    const QueryLimits& limits) {
  return answer_all(tree, rays, results, false, limits, nullptr,
                    [&](const Ray& ray) { return closest_hit(tree, ray, limits); });
}

Status any_hits(const Tree& tree, std::span<const Ray> rays, std::span<RayResult> results,
                const QueryLimits& limits) {
  return answer_all(tree, rays, results, true, limits, nullptr,
                    [&](const Ray& ray) { return any_hit(tree, ray, limits); });
}

Status closest_hits(const Tree& tree, std::span<const Ray> rays, std::span<RayResult> results,
                    const FaceOptions& options) {
  RayWishes wishes{{BoundTree::of(tree), &options}, &meet_wishes};
  return answer_all(tree, rays, results, false, options.limits, &wishes,
                    [&](const Ray& ray) { return closest_hit(tree, ray, options); });
}

Status any_hits(const Tree& tree, std::span<const Ray> rays, std::span<RayResult> results,
                const FaceOptions& options) {
  RayWishes wishes{{BoundTree::of(tree), &options}, &meet_wishes};
  return answer_all(tree, rays, results, true, options.limits, &wishes,
                    [&](const Ray& ray) { return any_hit(tree, ray, options); });
}

}  // namespace boxtree
