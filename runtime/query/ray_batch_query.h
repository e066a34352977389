// SPDX-License-Identifier: MIT
// The closest or any hits of many rays in one tree.
#pragma once

#include <cstddef>
#include <span>

#include <boxtree/ray_batch.h>

#include "runtime/query/ray_query.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree {

/// Every ray gets its answer by one of these functions.
struct RayBatch {
  const BoundTree& tree;
  std::span<const Ray> rays;
  std::span<RayResult> results;  // as many
  bool any;                      // any hit is enough
  RayWishes* wishes;             // null: every face may be hit
  FunctionRef<RayResult(const Ray& ray)> alone;

  /// By a walk of its own.
  void answer_alone(std::size_t i) { results[i] = alone(rays[i]); }
  void answer_nothing(std::size_t i) { results[i] = {}; }
  /// By the hit of a test that has seen every triangle that can matter.
  void answer(std::size_t i, RayTest& test);
};

/// By vectors; see walk_tree.h. Precondition: the tree has wide and float nodes.
void walk_wide(RayBatch& batch);

}  // namespace boxtree
