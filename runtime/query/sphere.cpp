// SPDX-License-Identifier: MIT
// Sphere queries over any codec.
#include <algorithm>
#include <cmath>

#include <boxtree/overlap.h>

#include "runtime/primitive/float_state.h"
#include "runtime/query/invalid_query.h"
#include "runtime/query/shape_query.h"
#include "runtime/walk/walk_tree.h"

namespace boxtree {

Result<Visit> visit_sphere(const BoundTree& tree, const SphereQuery& sphere, FaceVisitor visitor,
                           QueryWork& work) {
  return visit_faces(tree, sphere, visitor, work);
}

Result<Visit> overlap_sphere(const Tree& queried, const Eigen::Vector3d& center, double radius,
                             FaceVisitor visitor, const QueryLimits& limits) {
  const DefaultFloatState state;
  const BoundTree& tree = BoundTree::of(queried);
  const Eigen::Vector3d tree_center = tree.frame().to_tree(center);
  if (!is_within_range(tree_center)) return invalid_query("center");
  if (!(radius >= 0) || !std::isfinite(radius)) return invalid_query("radius");
  // Twice kMaxCoordinate spans every distance that can occur; a larger radius changes no answer.
  const double tree_radius = std::min(radius * tree.frame().inverse_scale, 4 * kMaxCoordinate);
  QueryWork work(limits);
  return visit_sphere(tree, SphereQuery{tree_center, tree_radius * tree_radius}, visitor, work);
}

}  // namespace boxtree
