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

QueriedPoint::QueriedPoint(const BoundTree& tree, const Eigen::Vector3d& queried,
                           double max_distance) noexcept
    : point(tree.frame().to_tree(queried)) {
  if (max_distance >= 0) {
    most = largest_square_within(max_distance * tree.frame().inverse_scale);
  } else {
    invalid = "max_distance";
  }
  if (!is_within_range(point)) invalid = "point";
}

PointResult described(PointQuery& query) noexcept {
  query.name_face();
  if (!query.found) return {};
  const Frame& frame = query.tree.frame();
  ClosestPoint found = *query.found;
  found.point = frame.to_object(found.point);
  found.distance = std::sqrt(found.distance) * frame.scale;
  return found;
}

PointResult closest_point(const Tree& queried, const Eigen::Vector3d& point, double max_distance,
                          const QueryLimits& limits) {
  const DefaultFloatState state;
  const BoundTree& tree = BoundTree::of(queried);
  const QueriedPoint in_tree(tree, point, max_distance);
  if (in_tree.invalid != nullptr) return {Errc::kInvalidQuery, in_tree.invalid};
  QueryWork work(limits);
  WalkBound nodes(tree.node_count(), &work);
  PointQuery query(tree, nodes, in_tree.point, in_tree.most);
  if (const Errc error = walk_nearest(tree, query); error != Errc::kOk) return error;
  if (query.error != Errc::kOk) return query.error;
  return described(query);
}

}  // namespace boxtree
