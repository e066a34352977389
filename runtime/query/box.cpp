// SPDX-License-Identifier: MIT
// Box queries over any codec.
#include <boxtree/overlap.h>

#include "runtime/primitive/float_state.h"
#include "runtime/query/invalid_query.h"
#include "runtime/query/shape_query.h"
#include "runtime/walk/walk_tree.h"

namespace boxtree {

QueriedShape<BoxQuery> in_tree_space(const BoundTree& tree,
                                     const Eigen::AlignedBox3d& box) noexcept {
  if (!is_finite_box(box)) return {"box", {}};
  const auto clamped = [&](const Eigen::Vector3d& corner) -> Eigen::Vector3d {
    return tree.frame().to_tree(corner).cwiseMax(-kMaxCoordinate).cwiseMin(kMaxCoordinate);
  };
  return {nullptr, {clamped(box.min()), clamped(box.max())}};
}

Result<Visit> overlap_box(const Tree& queried, const Eigen::AlignedBox3d& box, FaceVisitor visitor,
                          const QueryLimits& limits) {
  const DefaultFloatState state;
  const BoundTree& tree = BoundTree::of(queried);
  const QueriedShape<BoxQuery> query = in_tree_space(tree, box);
  if (query.invalid != nullptr) return invalid_query(query.invalid);
  QueryWork work(limits);
  return visit_faces(tree, query.shape, visitor, work);
}

}  // namespace boxtree
