// SPDX-License-Identifier: MIT
// Rays through a scene.
#include <algorithm>
#include <cmath>

#include <boxtree/scene.h>
#include <boxtree/scene_ray_batch.h>

#include "runtime/primitive/float_state.h"
#include "runtime/primitive/normal.h"
#include "runtime/query/invalid_query.h"
#include "runtime/query/ray_query.h"
#include "runtime/scene/answer_each.h"
#include "runtime/scene/nearest_scene_hits.h"
#include "runtime/scene/scene_line.h"
#include "runtime/scene/scene_walk.h"

namespace boxtree {
namespace {

struct SceneRayQuery;

// What a caller wants besides the closest or any hit of any face.
struct SceneRayWishes {
  // Casts the ray, in object space, on an instance. A pointer, so that programs that have no wishes
  // do not link it.
  using Cast = Errc(SceneRayQuery& query, std::uint32_t instance, const BoundScene::Placed& placed,
                    const Ray& ray, RayCandidate& found);

  const SceneFaceOptions& options;
  Cast* cast;
  const SceneRayVisitor* all = nullptr;  // null: one hit is wanted
};

// Boxes of instances are widened by PlacementBounds::error(). What remains is the error of the
// ray's origin on its way to object space and back, which a larger max_abs adds to the slab's
// margin.
LineInScene ray_in_scene(const BoundScene& scene, const Ray& world) noexcept {
  const LineInUnits units(scene, world);
  const double largest = largest_in_frame(scene);
  const double origin = largest_magnitude(units.line.origin);
  const double max_abs = largest + 16 * scene.condition() * (origin + largest);
  return {units, line_in_frame(scene, units.line, max_abs)};
}

struct SceneRayQuery : LineInScene {
  SceneRayQuery(const Admission& admitted, const Ray& in_world, bool stop_at_first,
                const SceneRayWishes* ray_wishes) noexcept
      : LineInScene(ray_in_scene(admitted.scene, in_world)),
        admission(admitted),
        any(stop_at_first),
        wishes(ray_wishes) {}

  [[nodiscard]] bool is_done() const noexcept {
    return error != Errc::kOk || stopped || (any && best.is_hit);
  }

  [[nodiscard]] bool visit(std::uint32_t instance, const BoundScene::Placed& placed) {
    RayCandidate found;
    const Ray in_object = placed.placement.to_object(line);
    error = wishes == nullptr ? cast_ray(*placed.tree, in_object, any, admission.work, found)
                              : wishes->cast(*this, instance, placed, in_object, found);
    if (!found.is_hit || error != Errc::kOk) return !is_done();
    if (best.is_hit && found.t == best.t &&
        !admission.scene.comes_first(placed.id, found.face, best_id, best.face)) {
      return true;
    }
    best = found;
    best_id = placed.id;
    best_instance = instance;
    best_to_units = placed.placement.to_world();
    line.t_max = found.t;
    return !is_done();
  }

  // What a caller is told of a hit on an instance, by the map from its tree space.
  [[nodiscard]] SceneRayHit described(const RayCandidate& hit, std::uint32_t instance,
                                      const AffineMap& to_units) const noexcept {
    return {{parameter_of(world, hit.t, parameter_exponent), hit.face, hit.half, hit.u, hit.v,
             admission.scene.to_world(to_units.apply(hit.point())),
             placed_normal(to_units.linear, unit_normal(hit.triangle))},
            instance};
  }

  Admission admission;
  bool any;
  const SceneRayWishes* wishes;
  RayCandidate best;
  std::uint32_t best_id = 0;
  std::uint32_t best_instance = 0;
  AffineMap best_to_units;  // from its tree space
  Errc error = Errc::kOk;
  bool stopped = false;
};

// See SceneRayWishes::Cast.
Errc cast_with_wishes(SceneRayQuery& query, std::uint32_t instance,
                      const BoundScene::Placed& placed, const Ray& ray, RayCandidate& found) {
  const SceneRayWishes& wishes = *query.wishes;
  const OptionsOfInstance options(wishes.options, instance);
  RayWishes of_tree{{*placed.tree, &options.of_tree()}, &meet_wishes};
  const auto visit = [&](const RayTest& in_tree, const RayCandidate& hit) {
    RayCandidate in_scene = hit;
    in_scene.t = parameter_of(ray, hit.t, in_tree.parameter_exponent);
    const double to = RayInTree::scaled(
        (*wishes.all)(query.described(in_scene, instance, placed.placement.to_world())),
        query.parameter_exponent);
    query.line.t_max = std::min(query.line.t_max, to);
    return RayInTree::scaled(to, in_tree.parameter_exponent);
  };
  const RayWishes::Visitor all(visit);
  if (wishes.all != nullptr) of_tree.all = &all;
  const Errc error = cast_ray(*placed.tree, ray, query.any, query.admission.work, found, &of_tree);
  query.stopped = of_tree.faces.stopped;
  return error;
}

// The name of what is not valid, or null.
const char* invalid_part(const BoundScene& scene, const Ray& ray) {
  const bool is_valid = invalid_field(ray, largest_magnitude(ray.direction)) == nullptr &&
                        is_within_range(scene.to_units(ray.origin));
  return is_valid ? nullptr : refused_field(ray);
}

SceneRayResult one_hit(const BoundScene& scene, const Ray& ray, bool stop_at_first,
                       const Admission& admission, const SceneRayWishes* wishes) {
  if ((scene.query_kinds() & kRayQueries) == 0) return Errc::kPartLeftOut;
  if (const char* invalid = invalid_part(scene, ray)) return {Errc::kInvalidQuery, invalid};
  SceneRayQuery query(admission, ray, stop_at_first, wishes);
  const Errc walked = visit_nearest_instances(scene, query);
  if (walked != Errc::kOk) return walked;
  if (query.error != Errc::kOk) return query.error;
  if (!query.best.is_hit) return {};
  return query.described(query.best, query.best_instance, query.best_to_units);
}

SceneRayResult plain_hit(const Scene& queried, const Ray& ray, bool stop_at_first, LayerMask layers,
                         const QueryLimits& limits) {
  const DefaultFloatState state;
  const BoundScene& scene = BoundScene::of(queried);
  QueryWork work(limits);
  return one_hit(scene, ray, stop_at_first, {scene, kRayQueries, layers, work}, nullptr);
}

SceneRayResult wanted_hit(const Scene& queried, const Ray& ray, bool stop_at_first,
                          const SceneFaceOptions& options) {
  const DefaultFloatState state;
  const BoundScene& scene = BoundScene::of(queried);
  QueryWork work(options.limits);
  const SceneRayWishes wishes{options, &cast_with_wishes};
  return one_hit(scene, ray, stop_at_first, admitted(scene, options, work), &wishes);
}

}  // namespace

SceneRayResult closest_hit(const Scene& scene, const Ray& ray, LayerMask layers,
                           const QueryLimits& limits) {
  return plain_hit(scene, ray, false, layers, limits);
}

SceneRayResult any_hit(const Scene& scene, const Ray& ray, LayerMask layers,
                       const QueryLimits& limits) {
  return plain_hit(scene, ray, true, layers, limits);
}

Status closest_hits(const Scene& scene, std::span<const Ray> rays,
                    std::span<SceneRayResult> results, LayerMask layers,
                    const QueryLimits& limits) {
  return answer_each(rays, results,
                     [&](const Ray& ray) { return closest_hit(scene, ray, layers, limits); });
}

Status any_hits(const Scene& scene, std::span<const Ray> rays, std::span<SceneRayResult> results,
                LayerMask layers, const QueryLimits& limits) {
  return answer_each(rays, results,
                     [&](const Ray& ray) { return any_hit(scene, ray, layers, limits); });
}

SceneRayResult closest_hit(const Scene& scene, const Ray& ray, const SceneFaceOptions& options) {
  return wanted_hit(scene, ray, false, options);
}

SceneRayResult any_hit(const Scene& scene, const Ray& ray, const SceneFaceOptions& options) {
  return wanted_hit(scene, ray, true, options);
}

Result<Visit> all_hits(const Scene& queried, const Ray& ray, SceneRayVisitor visitor,
                       const SceneFaceOptions& options) {
  const DefaultFloatState state;
  const BoundScene& scene = BoundScene::of(queried);
  QueryWork work(options.limits);
  if ((scene.query_kinds() & kRayQueries) == 0) return Errc::kPartLeftOut;
  if (const char* invalid = invalid_part(scene, ray)) return invalid_query(invalid);
  const SceneRayWishes wishes{options, &cast_with_wishes, &visitor};
  SceneRayQuery query(admitted(scene, options, work), ray, false, &wishes);
  return outcome_of(visit_nearest_instances(scene, query), query);
}

bool comes_first(const Scene& queried, const SceneRayHit& a, const SceneRayHit& b) noexcept {
  const BoundScene& scene = BoundScene::of(queried);
  if (a.t != b.t) return a.t < b.t;
  if (a.instance != b.instance) {
    return scene.comes_first(scene.record_of(a.instance)->id, a.face,
                             scene.record_of(b.instance)->id, b.face);
  }
  return comes_first(scene.trees()[scene.record_of(a.instance)->tree], a, b);
}

Result<std::size_t> nearest_hits(const Scene& scene, const Ray& ray, std::span<SceneRayHit> hits,
                                 const SceneFaceOptions& options) {
  return first_hits(scene, ray, HitRoom(hits), options);
}

}  // namespace boxtree
