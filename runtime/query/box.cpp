// SPDX-License-Identifier: MIT
// Box queries over any codec.
#include <boxtree/overlap.h>

#include "runtime/primitive/float_state.h"
#include "runtime/query/invalid_query.h"
#include "runtime/query/shape_query.h"
#include "runtime/walk/walk_tree.h"

namespace boxtree {
Result<Visit> overlap_box(const Tree& queried, const Eigen::AlignedBox3d& box, FaceVisitor visitor,
                          const QueryLimits& limits) {
  const DefaultFloatState state;
  const BoundTree& tree = BoundTree::of(queried);
  if (!is_finite_box(box)) return invalid_query("box");
  const BoxQuery query{
      tree.frame().to_tree(box.min()).cwiseMax(-kMaxCoordinate).cwiseMin(kMaxCoordinate),
      tree.frame().to_tree(box.max()).cwiseMax(-kMaxCoordinate).cwiseMin(kMaxCoordinate)};
  QueryWork work(limits);
  return visit_faces(tree, query, visitor, work);
}

}  // namespace boxtree
