// SPDX-License-Identifier: MIT
// Casts, contacts and overlaps of the convex hull of points.
#include "runtime/query/hull_in_tree.h"
#include "runtime/query/shape_casts.h"

namespace boxtree {

CastResult cast_closest(const Tree& tree, const ConvexHull& hull, const Motion& motion,
                        const FaceOptions& options) {
  const BoundTree& bound = BoundTree::of(tree);
  return one_touch_in(bound, HullInTree(bound.frame(), hull).shape(), motion,
                      CastQuery::Wanted::kClosest, options);
}

CastResult cast_any(const Tree& tree, const ConvexHull& hull, const Motion& motion,
                    const FaceOptions& options) {
  const BoundTree& bound = BoundTree::of(tree);
  return one_touch_in(bound, HullInTree(bound.frame(), hull).shape(), motion,
                      CastQuery::Wanted::kAny, options);
}

Result<Visit> cast_all(const Tree& tree, const ConvexHull& hull, const Motion& motion,
                       CastVisitor visitor, const FaceOptions& options) {
  const BoundTree& bound = BoundTree::of(tree);
  return all_touches_in(bound, HullInTree(bound.frame(), hull).shape(), motion, visitor, options);
}

#if BOXTREE_HAS_COLLIDE_QUERIES
Result<Visit> collide(const Tree& tree, const ConvexHull& hull, ContactVisitor visitor,
                      const QueryLimits& limits) {
  const BoundTree& bound = BoundTree::of(tree);
  return visit_contacts_in(bound, HullInTree(bound.frame(), hull).shape(), visitor, limits);
}

Result<Visit> overlap_convex_hull(const Tree& tree, const ConvexHull& hull, FaceVisitor visitor,
                                  const QueryLimits& limits) {
  const BoundTree& bound = BoundTree::of(tree);
  return visit_touched_faces_in(bound, HullInTree(bound.frame(), hull).shape(), visitor, limits);
}
#endif

}  // namespace boxtree
