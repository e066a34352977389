// SPDX-License-Identifier: MIT
// Closest-point queries over any codec.
#include <algorithm>
#include <cmath>

#include <boxtree/runtime/query/float_state.h>
#include <boxtree/runtime/query/point.h>
#include <boxtree/runtime/wide/walks.h>

namespace boxtree {
Result<std::optional<ClosestPoint>> closest_point(const Tree& tree, const Eigen::Vector3d& point,
                                                  double max_distance) {
  const DefaultFloatState state;
  const Eigen::Vector3d tree_point = tree.frame().to_tree(point);
  if (!is_within_reach(tree_point) || !(max_distance >= 0)) return Errc::kInvalidQuery;
  const double tree_distance = max_distance * tree.frame().inverse_scale;
  PointQuery query{tree, tree_point, tree_distance * tree_distance, {}, Errc::kOk, {}};
  const Errc walked =
      with_codec(tree, [&](const auto& codec) { return walk_nearest(tree, codec, query); });
  if (walked != Errc::kOk) return walked;
  if (query.error != Errc::kOk) return query.error;
  if (query.found) {
    query.found->point = tree.frame().to_object(query.found->point);
    query.found->distance = std::sqrt(query.found->distance) * tree.frame().scale;
  }
  return query.found;
}

}  // namespace boxtree
