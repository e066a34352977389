// SPDX-License-Identifier: MIT
// Batches of spheres.
#include "runtime/query/overlap_batch_query.h"

namespace boxtree {

Status overlap_spheres(const Tree& tree, std::span<const Sphere> spheres,
                       std::span<VisitResult> results, BatchFaceVisitor visitor,
                       const QueryLimits& limits) {
  return visit_batch<SphereBatch>(tree, spheres, results, visitor, limits);
}

}  // namespace boxtree
