// SPDX-License-Identifier: MIT
// The application's own traversals: one walk for all codecs.
#include <boxtree/traverse.h>

#include "runtime/primitive/float_state.h"
#include "runtime/walk/erased_codec.h"
#include "runtime/walk/read_leaf.h"
#include "runtime/walk/traversal.h"

namespace boxtree {
namespace {

// A query of traverse_overlap.
struct OwnTraversal {
  const BoundTree& tree;
  BoxTest intersect;
  TriangleVisitor visitor;
  WalkBound& nodes;
  Errc error = Errc::kOk;
  bool stopped = false;
  TriangleBatch batch;

  [[nodiscard]] bool overlaps(const Box<double>& box) const {
    return intersect(tree.to_object(box));
  }

  [[nodiscard]] bool leaf(NodeRef ref) {
    error = read_leaf(tree, ref, batch);
    if (error != Errc::kOk) return false;
    for (std::uint32_t i = 0; i < batch.count && !stopped; ++i) {
      LeafTriangle found{batch.triangle(i), face_ref(tree, batch.face[i]), half_of_face(batch, i)};
      for (Eigen::Vector3d& corner : found.triangle.corner) {
        corner = tree.frame().to_object(corner);
      }
      stopped = !visitor(found);
    }
    return !stopped;
  }
};

}  // namespace

Result<Visit> traverse(const Tree& queried, BoxTest intersect, TriangleVisitor visitor,
                       const QueryLimits& limits) {
  const DefaultFloatState state;
  const BoundTree& tree = BoundTree::of(queried);
  QueryWork work(limits);
  WalkBound nodes(tree.node_count(), &work);
  OwnTraversal query{tree, intersect, visitor, nodes, Errc::kOk, false, {}};
  return outcome_of(traverse_overlap(tree, ErasedCodec{&tree}, query), query);
}

}  // namespace boxtree
