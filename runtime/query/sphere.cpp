// SPDX-License-Identifier: MIT
// Sphere queries over any codec.
#include <algorithm>
#include <cmath>

#include <boxtree/overlap.h>

#include "runtime/primitive/float_state.h"
#include "runtime/primitive/rounding.h"
#include "runtime/query/invalid_query.h"
#include "runtime/query/shape_query.h"
#include "runtime/walk/walk_tree.h"

namespace boxtree {

Result<Visit> visit_sphere(const BoundTree& tree, const SphereQuery& sphere, FaceVisitor visitor,
                           QueryWork& work) {
  return visit_faces(tree, sphere, visitor, work);
}

QueriedShape<SphereQuery> in_tree_space(const BoundTree& tree, const Sphere& sphere) noexcept {
  const Eigen::Vector3d center = tree.frame().to_tree(sphere.center);
  if (!is_within_range(center)) return {"center", {}};
  if (!(sphere.radius >= 0) || !std::isfinite(sphere.radius)) return {"radius", {}};
  // Twice kMaxCoordinate spans every distance that can occur; a larger radius changes no answer.
  const double radius = std::min(sphere.radius * tree.frame().inverse_scale, 4 * kMaxCoordinate);
  return {nullptr, {center, largest_square_within(radius)}};
}

Result<Visit> overlap_sphere(const Tree& queried, const Eigen::Vector3d& center, double radius,
                             FaceVisitor visitor, const QueryLimits& limits) {
  const DefaultFloatState state;
  const BoundTree& tree = BoundTree::of(queried);
  const QueriedShape<SphereQuery> query = in_tree_space(tree, Sphere{center, radius});
  if (query.invalid != nullptr) return invalid_query(query.invalid);
  QueryWork work(limits);
  return visit_sphere(tree, query.shape, visitor, work);
}

}  // namespace boxtree
