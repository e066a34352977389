// SPDX-License-Identifier: MIT
// Casts in a scene.
#include <algorithm>
#include <cmath>

#include <boxtree/scene_cast.h>

#include "runtime/primitive/float_state.h"
#include "runtime/query/cast_query.h"
#include "runtime/query/invalid_query.h"
#include "runtime/scene/placed_cast.h"
#include "runtime/scene/scene_line.h"
#include "runtime/scene/scene_shape_casts.h"
#include "runtime/scene/scene_walk.h"

namespace boxtree {
namespace {

// Triangles are compared in units of the scene; boxes, in its frame, are widened by the shape and
// by what rounding on the way there, and MovingShape, may be off.
LineInScene cast_in_scene(const BoundScene& scene, const ConvexShape& shape,
                          const Ray& world) noexcept {
  const LineInUnits units(scene, world);
  const Eigen::Vector3d extent = shape.half_extents();
  const double largest = largest_in_frame(scene) + 2 * largest_magnitude(extent);
  const double origins = largest_magnitude(units.line.origin) +
                         largest_magnitude(scene.to_units(scene.frame().origin));
  return {units, line_in_frame(scene, units.line, 16 * (largest + origins), extent)};
}

struct SceneCastQuery : LineInScene {
  SceneCastQuery(const Admission& admitted, const ShapeInTree& shape_in_units,
                 const CastLine& in_world, const SceneFaceOptions& face_options,
                 CastQuery::Wanted wanted_touches, const SceneCastVisitor* visitor) noexcept
      : LineInScene(cast_in_scene(admitted.scene, shape_in_units.shape, in_world.line)),
        admission(admitted),
        shape(shape_in_units.shape),
        is_moving(in_world.is_moving),
        options(face_options),
        wanted(wanted_touches),
        all(visitor) {}

  [[nodiscard]] bool is_done() const noexcept {
    return error != Errc::kOk || stopped || (wanted == CastQuery::Wanted::kAny && best.is_hit);
  }

  [[nodiscard]] bool visit(std::uint32_t instance, const BoundScene::Placed& placed) {
    const BoundTree& tree = *placed.tree;
    const InstanceCast on_instance({shape, line, is_moving}, placed);
    const OptionsOfInstance of_instance(options, instance);
    const auto touched = [&](const CastQuery& query, const CastCandidate& found) {
      const double to = RayInTree::scaled((*all)(described(tree, query.moving, found, instance)),
                                          parameter_exponent);
      line.t_max = std::min(line.t_max, to);
      return to;
    };
    const CastQuery::Visitor visitor(touched);
    WalkBound nodes(tree.node_count(), &admission.work);
    CastQuery query(tree, on_instance.path(), wanted, all == nullptr ? nullptr : &visitor, nodes,
                    &of_instance.of_tree());
    error = query.run();
    stopped = query.faces.stopped;
    if (!query.best.is_hit || error != Errc::kOk) return !is_done();
    CastCandidate& found = query.best;
    name(tree, found.face);
    if (best.is_hit && found.touch.s == best.touch.s &&
        !admission.scene.comes_first(placed.id, found.face, best_id, best.face)) {
      return true;
    }
    best = found;
    best_id = placed.id;
    best_instance = instance;
    best_tree = &tree;
    best_moving = query.moving;
    line.t_max = found.touch.s;
    return !is_done();
  }

  [[nodiscard]] SceneCastHit described(const BoundTree& tree, const MovingShape& moving,
                                       const CastCandidate& found,
                                       std::uint32_t instance) const noexcept {
    return {hit_of(tree, moving, found, world, parameter_exponent, admission.scene.units()),
            instance};
  }

  Admission admission;
  const ConvexShape& shape;
  bool is_moving;
  const SceneFaceOptions& options;
  CastQuery::Wanted wanted;
  const SceneCastVisitor* all;  // of kAll, or null
  CastCandidate best;
  std::uint32_t best_id = 0;
  std::uint32_t best_instance = 0;
  const BoundTree* best_tree = nullptr;
  MovingShape best_moving;
  Errc error = Errc::kOk;
  bool stopped = false;
};

}  // namespace

SceneCastResult one_touch_in(const BoundScene& scene, const ShapeInTree& shape,
                             const Motion& motion, CastQuery::Wanted wanted,
                             const SceneFaceOptions& options) {
  if ((scene.query_kinds() & kRayQueries) == 0) return Errc::kPartLeftOut;
  const CastLine line(shape, motion);
  if (line.invalid != nullptr) return {Errc::kInvalidQuery, line.invalid};
  QueryWork work(options.limits);
  SceneCastQuery query(admitted(scene, options, work), shape, line, options, wanted, nullptr);
  const Errc walked = visit_nearest_instances(scene, query);
  if (walked != Errc::kOk) return walked;
  if (query.error != Errc::kOk) return query.error;
  if (!query.best.is_hit) return {};
  return query.described(*query.best_tree, query.best_moving, query.best, query.best_instance);
}

Result<Visit> all_touches_in(const BoundScene& scene, const ShapeInTree& shape,
                             const Motion& motion, SceneCastVisitor visitor,
                             const SceneFaceOptions& options) {
  if ((scene.query_kinds() & kRayQueries) == 0) return Errc::kPartLeftOut;
  const CastLine line(shape, motion);
  if (line.invalid != nullptr) return invalid_query(line.invalid);
  QueryWork work(options.limits);
  SceneCastQuery query(admitted(scene, options, work), shape, line, options,
                       CastQuery::Wanted::kAll, &visitor);
  return outcome_of(visit_nearest_instances(scene, query), query);
}

namespace {

template <class Shape>
SceneCastResult one_touch(const Scene& queried, const Shape& shape, const Motion& motion,
                          CastQuery::Wanted wanted, const SceneFaceOptions& options) {
  const DefaultFloatState state;
  const BoundScene& scene = BoundScene::of(queried);
  return one_touch_in(scene, in_tree(scene.units(), shape), motion, wanted, options);
}

template <class Shape>
Result<Visit> all_touches(const Scene& queried, const Shape& shape, const Motion& motion,
                          SceneCastVisitor visitor, const SceneFaceOptions& options) {
  const DefaultFloatState state;
  const BoundScene& scene = BoundScene::of(queried);
  return all_touches_in(scene, in_tree(scene.units(), shape), motion, visitor, options);
}

}  // namespace

Result<std::uint32_t> active_edges(const Scene& queried, const SceneFace& face,
                                   std::uint32_t half) {
  const DefaultFloatState state;
  const BoundScene& scene = BoundScene::of(queried);
  const Result<InstanceInfo> info = scene.info(face.instance);
  if (!info) return info.error();
  const Result<std::uint32_t> of_tree = active_edges(scene.trees()[info->tree], face.face, half);
  const auto placed = scene.place_now(face.instance);
  if (!of_tree || !placed) return of_tree;
  const std::uint32_t original = placed->tree->original_of(face.face.index);
  return *of_tree & ~placed->inactive.of_triangle(original, half);
}

SceneCastResult cast_closest(const Scene& scene, const Sphere& sphere, const Motion& motion,
                             const SceneFaceOptions& options) {
  return one_touch(scene, sphere, motion, CastQuery::Wanted::kClosest, options);
}
SceneCastResult cast_closest(const Scene& scene, const Capsule& capsule, const Motion& motion,
                             const SceneFaceOptions& options) {
  return one_touch(scene, capsule, motion, CastQuery::Wanted::kClosest, options);
}
SceneCastResult cast_closest(const Scene& scene, const OrientedBox& box, const Motion& motion,
                             const SceneFaceOptions& options) {
  return one_touch(scene, box, motion, CastQuery::Wanted::kClosest, options);
}

SceneCastResult cast_any(const Scene& scene, const Sphere& sphere, const Motion& motion,
                         const SceneFaceOptions& options) {
  return one_touch(scene, sphere, motion, CastQuery::Wanted::kAny, options);
}
SceneCastResult cast_any(const Scene& scene, const Capsule& capsule, const Motion& motion,
                         const SceneFaceOptions& options) {
  return one_touch(scene, capsule, motion, CastQuery::Wanted::kAny, options);
}
SceneCastResult cast_any(const Scene& scene, const OrientedBox& box, const Motion& motion,
                         const SceneFaceOptions& options) {
  return one_touch(scene, box, motion, CastQuery::Wanted::kAny, options);
}

Result<Visit> cast_all(const Scene& scene, const Sphere& sphere, const Motion& motion,
                       SceneCastVisitor visitor, const SceneFaceOptions& options) {
  return all_touches(scene, sphere, motion, visitor, options);
}
Result<Visit> cast_all(const Scene& scene, const Capsule& capsule, const Motion& motion,
                       SceneCastVisitor visitor, const SceneFaceOptions& options) {
  return all_touches(scene, capsule, motion, visitor, options);
}
Result<Visit> cast_all(const Scene& scene, const OrientedBox& box, const Motion& motion,
                       SceneCastVisitor visitor, const SceneFaceOptions& options) {
  return all_touches(scene, box, motion, visitor, options);
}

}  // namespace boxtree
