// SPDX-License-Identifier: MIT
// Contacts and overlaps of convex shapes in a scene.
#include <boxtree/scene_collide.h>

#include "runtime/primitive/float_state.h"
#include "runtime/query/collide_query.h"
#include "runtime/query/invalid_query.h"
#include "runtime/scene/placed_cast.h"
#include "runtime/scene/scene_line.h"
#include "runtime/scene/scene_shape_casts.h"
#include "runtime/scene/scene_walk.h"

namespace boxtree {
namespace {

// `visit_touch(instance, query, candidate)` -> bool, whether to go on: see visit_touched.
template <class VisitTouch>
struct SceneCollideQuery : BoxInFrame, InstanceOutcome {
  Admission admission;
  UnitCast cast;  // of no length
  CastQuery::Wanted wanted;
  const VisitTouch& visit_touch;

  [[nodiscard]] bool visit(std::uint32_t instance, const BoundScene::Placed& placed) {
    const InstanceCast on_instance(cast, placed);
    return note(visit_touched(*placed.tree, on_instance.path(), wanted, admission.work,
                              [&](const CastQuery& query, const CastCandidate& found) {
                                return visit_touch(instance, query, found);
                              }));
  }
};

// The bounds of a shape in the scene's frame, widened by what it may be off there.
Box<double> bounds_in_frame(const BoundScene& scene, const UnitCast& cast) noexcept {
  const Eigen::Vector3d& center = cast.line.origin;
  const Eigen::Vector3d extent = cast.shape.half_extents();
  const Eigen::Vector3d widened =
      extent.array() + frame_error(scene, largest_magnitude(center) + largest_magnitude(extent) +
                                              largest_in_frame(scene));
  const Eigen::Vector3d at = scene.to_frame(center);
  const Eigen::Vector3d low = at - widened, high = at + widened;
  return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

template <class VisitTouch>
Result<Visit> visit_touched_in(const BoundScene& scene, const ShapeInTree& shape, LayerMask layers,
                               const QueryLimits& limits, CastQuery::Wanted wanted,
                               const VisitTouch& visit_touch) {
  if ((scene.query_kinds() & kBoxQueries) == 0) return Errc::kPartLeftOut;
  if (shape.invalid != nullptr) return invalid_query(shape.invalid);
  QueryWork work(limits);
  const Ray line = line_at(scene.to_units(shape.center));
  const UnitCast cast{shape.shape, line, false};
  SceneCollideQuery<VisitTouch> query{{bounds_in_frame(scene, cast)},
                                      {},
                                      {scene, kBoxQueries, layers, work},
                                      cast,
                                      wanted,
                                      visit_touch};
  return outcome_of(visit_overlapping_instances(scene, query), query);
}

}  // namespace

Result<Visit> visit_contacts_in(const BoundScene& scene, const ShapeInTree& shape,
                                SceneContactVisitor visitor, LayerMask layers,
                                const QueryLimits& limits) {
  const Frame units = scene.units();
  return visit_touched_in(
      scene, shape, layers, limits, CastQuery::Wanted::kContacts,
      [&](std::uint32_t instance, const CastQuery& query, const CastCandidate& found) {
        return visitor({contact_of(query, found, units), instance});
      });
}

Result<Visit> visit_touched_faces_in(const BoundScene& scene, const ShapeInTree& shape,
                                     SceneFaceVisitor visitor, LayerMask layers,
                                     const QueryLimits& limits) {
  VisitedFaces visited;
  std::uint32_t last = kNoInstance;
  return visit_touched_in(
      scene, shape, layers, limits, CastQuery::Wanted::kFaces,
      [&](std::uint32_t instance, const CastQuery&, const CastCandidate& found) {
        if (instance != last) visited = {};
        last = instance;
        return !visited.is_new(found) || visitor({instance, found.face});
      });
}

namespace {

template <class Shape>
Result<Visit> visit_contacts(const Scene& queried, const Shape& shape, SceneContactVisitor visitor,
                             LayerMask layers, const QueryLimits& limits) {
  const DefaultFloatState state;
  const BoundScene& scene = BoundScene::of(queried);
  return visit_contacts_in(scene, in_tree(scene.units(), shape), visitor, layers, limits);
}

template <class Shape>
Result<Visit> visit_faces_of(const Scene& queried, const Shape& shape, SceneFaceVisitor visitor,
                             LayerMask layers, const QueryLimits& limits) {
  const DefaultFloatState state;
  const BoundScene& scene = BoundScene::of(queried);
  return visit_touched_faces_in(scene, in_tree(scene.units(), shape), visitor, layers, limits);
}

}  // namespace

Result<Visit> collide(const Scene& scene, const Sphere& sphere, SceneContactVisitor visitor,
                      LayerMask layers, const QueryLimits& limits) {
  return visit_contacts(scene, sphere, visitor, layers, limits);
}
Result<Visit> collide(const Scene& scene, const Capsule& capsule, SceneContactVisitor visitor,
                      LayerMask layers, const QueryLimits& limits) {
  return visit_contacts(scene, capsule, visitor, layers, limits);
}
Result<Visit> collide(const Scene& scene, const OrientedBox& box, SceneContactVisitor visitor,
                      LayerMask layers, const QueryLimits& limits) {
  return visit_contacts(scene, box, visitor, layers, limits);
}

Result<Visit> overlap_capsule(const Scene& scene, const Capsule& capsule, SceneFaceVisitor visitor,
                              LayerMask layers, const QueryLimits& limits) {
  return visit_faces_of(scene, capsule, visitor, layers, limits);
}
Result<Visit> overlap_oriented_box(const Scene& scene, const OrientedBox& box,
                                   SceneFaceVisitor visitor, LayerMask layers,
                                   const QueryLimits& limits) {
  return visit_faces_of(scene, box, visitor, layers, limits);
}

std::size_t merge_contacts(std::span<SceneContact> contacts, double distance, double cosine) {
  return merge(contacts, distance, cosine);
}

}  // namespace boxtree
