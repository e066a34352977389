// SPDX-License-Identifier: MIT
// Batches of points.
#include "runtime/query/invalid_query.h"
#include "runtime/query/point_batch_query.h"
#include "runtime/walk/packets.h"

namespace boxtree {

Status closest_points(const Tree& tree, std::span<const Eigen::Vector3d> points,
                      std::span<PointResult> results, double max_distance,
                      const QueryLimits& limits) {
  if (results.size() != points.size()) return invalid_query("results.size()");
  const auto alone = [&](const Eigen::Vector3d& point) {
    return closest_point(tree, point, max_distance, limits);
  };
  PointBatch batch{BoundTree::of(tree), points, results, max_distance, alone};
  answer_batch(batch, limits);
  return {};
}

}  // namespace boxtree
