// SPDX-License-Identifier: MIT
// The closest points to many points in one tree.
#pragma once

#include <cstddef>
#include <span>

#include <boxtree/closest_batch.h>

#include "runtime/query/point_query.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree {

/// Every point gets its answer by one of these functions.
struct PointBatch {
  const BoundTree& tree;
  std::span<const Eigen::Vector3d> points;
  std::span<PointResult> results;  // as many
  double max_distance;
  FunctionRef<PointResult(const Eigen::Vector3d& point)> alone;

  /// By a walk of its own.
  void answer_alone(std::size_t i) { results[i] = alone(points[i]); }
  /// By a query that has tested every triangle that can matter.
  void answer(std::size_t i, PointQuery& query) { results[i] = described(query); }
};

/// By vectors; see walk_tree.h. Precondition: the tree has wide and float nodes.
void walk_wide(PointBatch& batch);

}  // namespace boxtree
