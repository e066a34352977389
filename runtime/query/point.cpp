// SPDX-License-Identifier: MIT
// Closest-point queries over any codec.
#include <cmath>

#include <boxtree/closest.h>

#include "runtime/primitive/float_state.h"
#include "runtime/primitive/rounding.h"
#include "runtime/query/point_query.h"
#include "runtime/walk/walk_tree.h"

namespace boxtree {

Errc find_nearest(const BoundTree& tree, PointQuery& query) {
  const Errc walked = walk_nearest(tree, query);
  query.name_face();
  return walked != Errc::kOk ? walked : query.error;
}

PointResult closest_point(const Tree& queried, const Eigen::Vector3d& point, double max_distance,
                          const QueryLimits& limits) {
  const DefaultFloatState state;
  const BoundTree& tree = BoundTree::of(queried);
  const Eigen::Vector3d tree_point = tree.frame().to_tree(point);
  if (!is_within_range(tree_point)) return {Errc::kInvalidQuery, "point"};
  if (!(max_distance >= 0)) return {Errc::kInvalidQuery, "max_distance"};
  const double tree_distance = max_distance * tree.frame().inverse_scale;
  QueryWork work(limits);
  WalkBound nodes(tree.node_count(), &work);
  PointQuery query{tree, nodes, tree_point, tree_distance * tree_distance, {}, Errc::kOk, {}};
  if (const Errc error = find_nearest(tree, query); error != Errc::kOk) return error;
  if (!query.found) return {};
  query.found->point = tree.frame().to_object(query.found->point);
  query.found->distance = std::sqrt(query.found->distance) * tree.frame().scale;
  return *query.found;
}

}  // namespace boxtree
