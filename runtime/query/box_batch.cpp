// SPDX-License-Identifier: MIT
// Batches of boxes.
#include "runtime/query/overlap_batch_query.h"

namespace boxtree {

Status overlap_boxes(const Tree& tree, std::span<const Eigen::AlignedBox3d> boxes,
                     std::span<VisitResult> results, BatchFaceVisitor visitor,
                     const QueryLimits& limits) {
  return visit_batch<BoxBatch>(tree, boxes, results, visitor, limits);
}

}  // namespace boxtree
