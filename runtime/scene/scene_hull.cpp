// SPDX-License-Identifier: MIT
// Casts, contacts and overlaps of the convex hull of points in a scene.
#include "runtime/query/hull_in_tree.h"
#include "runtime/scene/scene_shape_casts.h"

namespace boxtree {

SceneCastResult cast_closest(const Scene& queried, const ConvexHull& hull, const Motion& motion,
                             const SceneFaceOptions& options) {
  const BoundScene& scene = BoundScene::of(queried);
  return one_touch_in(scene, HullInTree(scene.units(), hull).shape(), motion,
                      CastQuery::Wanted::kClosest, options);
}

SceneCastResult cast_any(const Scene& queried, const ConvexHull& hull, const Motion& motion,
                         const SceneFaceOptions& options) {
  const BoundScene& scene = BoundScene::of(queried);
  return one_touch_in(scene, HullInTree(scene.units(), hull).shape(), motion,
                      CastQuery::Wanted::kAny, options);
}

Result<Visit> cast_all(const Scene& queried, const ConvexHull& hull, const Motion& motion,
                       SceneCastVisitor visitor, const SceneFaceOptions& options) {
  const BoundScene& scene = BoundScene::of(queried);
  return all_touches_in(scene, HullInTree(scene.units(), hull).shape(), motion, visitor, options);
}

#if BOXTREE_HAS_COLLIDE_QUERIES
Result<Visit> collide(const Scene& queried, const ConvexHull& hull, SceneContactVisitor visitor,
                      LayerMask layers, const QueryLimits& limits) {
  const BoundScene& scene = BoundScene::of(queried);
  return visit_contacts_in(scene, HullInTree(scene.units(), hull).shape(), visitor, layers, limits);
}

Result<Visit> overlap_convex_hull(const Scene& queried, const ConvexHull& hull,
                                  SceneFaceVisitor visitor, LayerMask layers,
                                  const QueryLimits& limits) {
  const BoundScene& scene = BoundScene::of(queried);
  return visit_touched_faces_in(scene, HullInTree(scene.units(), hull).shape(), visitor, layers,
                                limits);
}
#endif

}  // namespace boxtree
