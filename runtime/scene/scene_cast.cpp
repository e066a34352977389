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

// In units of the scene, with a direction whose largest component is in [1/2, 1): its parameter is
// t * 2^parameter_exponent. Triangles are compared there; boxes, in the scene's frame, are widened
// by the shape and by what rounding on the way there, and MovingShape, may be off.
struct SceneCastQuery {
  SceneCastQuery(const Admission& admitted, const ShapeInTree& shape, const CastLine& in_world,
                 const SceneFaceOptions& face_options, CastQuery::Wanted wanted_touches,
                 const SceneCastVisitor* visitor) noexcept
      : admission(admitted),
        world(in_world.line),
        exponent(exponent_of(largest_magnitude(world.direction))),
        parameter_exponent(exponent - scene().record().scale_exponent),
        cast{shape.shape,
             {scene().to_units(world.origin),
              RayInTree::scaled(AxisLanes(world.direction), -exponent).vector(), 0,
              RayInTree::scaled(world.t_max, parameter_exponent)},
             in_world.is_moving},
        options(face_options),
        wanted(wanted_touches),
        all(visitor),
        in_frame(make_in_frame()) {}

  [[nodiscard]] const BoundScene& scene() const noexcept { return admission.scene; }

  [[nodiscard]] TopLevelRay make_in_frame() const noexcept {
    const Eigen::Vector3d extent = cast.shape.half_extents();
    const double largest = largest_in_frame(scene()) + 2 * largest_magnitude(extent);
    const double origins = largest_magnitude(cast.line.origin) +
                           largest_magnitude(scene().to_units(scene().frame().origin));
    return line_in_frame(scene(), cast.line, 16 * (largest + origins), extent);
  }

  [[nodiscard]] bool is_done() const noexcept {
    return error != Errc::kOk || stopped || (wanted == CastQuery::Wanted::kAny && best.is_hit);
  }
  [[nodiscard]] double bound() const noexcept { return cast.line.t_max; }
  template <class S>
  [[nodiscard]] double key(const Box<S>& box) const noexcept {
    return in_frame.slab.key(box, in_frame.s_min);
  }
  [[nodiscard]] Errc walk(const TopLevel& top, InstanceVisitor instances) const {
    return walk_top_level(top, instances, in_frame, cast.line.t_max);
  }

  [[nodiscard]] bool visit(std::uint32_t instance, const BoundScene::Placed& placed) {
    const BoundTree& tree = *placed.tree;
    const InstanceCast on_instance(cast, placed);
    const OptionsOfInstance of_instance(options, instance);
    const auto touched = [&](const CastQuery& query, const CastCandidate& found) {
      const double to = RayInTree::scaled((*all)(described(tree, query.moving, found, instance)),
                                          parameter_exponent);
      cast.line.t_max = std::min(cast.line.t_max, to);
      return to;
    };
    const CastQuery::Visitor visitor(touched);
    WalkBound nodes(tree.node_count(), &admission.work);
    CastQuery query(tree, on_instance.path(), wanted, all == nullptr ? nullptr : &visitor, nodes,
                    &of_instance.of_tree());
    error = query.run();
    stopped = query.faces.stopped;
    if (!query.best.is_hit || error != Errc::kOk) return !is_done();
    const CastCandidate& found = query.best;
    if (best.is_hit && found.s == best.s && placed.id >= best_id) return true;
    best = found;
    name(tree, best.face);
    best_id = placed.id;
    best_instance = instance;
    best_tree = &tree;
    best_moving = query.moving;
    cast.line.t_max = found.s;
    return !is_done();
  }

  [[nodiscard]] SceneCastHit described(const BoundTree& tree, const MovingShape& moving,
                                       const CastCandidate& found,
                                       std::uint32_t instance) const noexcept {
    return {hit_of(tree, moving, found, world, parameter_exponent, scene().units()), instance};
  }

  Admission admission;
  const Ray& world;
  int exponent;  // of the direction in the world
  int parameter_exponent;
  UnitCast cast;  // t_max of its line shrinks to the best touch
  const SceneFaceOptions& options;
  CastQuery::Wanted wanted;
  const SceneCastVisitor* all;  // of kAll, or null
  TopLevelRay in_frame;
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
