// SPDX-License-Identifier: MIT
// Rays through a scene.
#include <cmath>

#include <boxtree/scene.h>

#include "runtime/primitive/float_state.h"
#include "runtime/primitive/normal.h"
#include "runtime/query/ray_query.h"
#include "runtime/scene/scene_walk.h"

namespace boxtree {
namespace {

// In units of the scene, with a direction whose largest component is in [1/2, 1): its parameter is
// t * 2^parameter_exponent. Boxes of instances are widened by PlacementBounds::error(). What
// remains is the error of the ray's origin on its way to object space and back, which a larger
// max_abs adds to the slab's margin.
struct SceneRayQuery {
  SceneRayQuery(const BoundScene& scene, const Ray& world, bool stop_at_first, LayerMask layers,
                QueryWork& work, int direction_exponent) noexcept
      : admission{scene, kRayQueries, layers, work},
        exponent(direction_exponent),
        parameter_exponent(exponent - scene.record().scale_exponent),
        ray{scene.to_units(world.origin),
            RayQuery::scaled(AxisLanes(world.direction), -exponent).vector(),
            RayQuery::scaled(world.t_min, parameter_exponent),
            RayQuery::scaled(world.t_max, parameter_exponent)},
        any(stop_at_first),
        in_frame(make_in_frame(scene)) {}

  [[nodiscard]] TopLevelRay make_in_frame(const BoundScene& scene) const noexcept {
    const Eigen::Vector3d origin = scene.to_frame(ray.origin);
    const double widened = max_abs(scene);
    return {origin, ray.direction, widened, RaySlab(origin, ray.direction, widened), ray.t_min};
  }

  [[nodiscard]] double max_abs(const BoundScene& scene) const noexcept {
    double largest = max_abs_of(scene.top_level());
    if (!scene.moving_tree().empty()) {
      largest = std::max(largest, max_abs_of(scene.moving_tree().root_box()).maxCoeff());
    }
    const double origin = largest_magnitude(ray.origin);
    return largest + 16 * scene.condition() * (origin + largest);
  }

  [[nodiscard]] bool is_done() const noexcept { return error != Errc::kOk || (any && best.is_hit); }
  [[nodiscard]] double bound() const noexcept { return ray.t_max; }
  template <class S>
  [[nodiscard]] double key(const Box<S>& box) const noexcept {
    return in_frame.slab.key(box, in_frame.s_min);
  }
  [[nodiscard]] Errc walk(const TopLevel& top, InstanceVisitor instances) const {
    return walk_top_level(top, instances, in_frame, ray.t_max);
  }

  [[nodiscard]] bool visit(std::uint32_t instance, const BoundScene::Placed& placed) {
    RayCandidate found;
    error = cast_ray(*placed.tree, placed.placement.to_object(ray), any, admission.work, found);
    if (!found.is_hit || error != Errc::kOk) return error == Errc::kOk;
    if (best.is_hit && found.t == best.t && placed.id >= best_id) return true;
    best = found;
    best_id = placed.id;
    best_instance = instance;
    best_to_units = placed.placement.to_world();
    ray.t_max = found.t;
    return !is_done();
  }

  Admission admission;
  int exponent;  // of the direction in the world
  int parameter_exponent;
  Ray ray;  // t_max shrinks to the best hit
  bool any;
  TopLevelRay in_frame;
  RayCandidate best;
  std::uint32_t best_id = 0;
  std::uint32_t best_instance = 0;
  AffineMap best_to_units;  // from its tree space
  Errc error = Errc::kOk;
};

SceneRayResult cast(const Scene& queried, const Ray& ray, bool stop_at_first, LayerMask layers,
                    const QueryLimits& limits) {
  const DefaultFloatState state;
  const BoundScene& scene = BoundScene::of(queried);
  QueryWork work(limits);
  if ((scene.query_kinds() & kRayQueries) == 0) return Errc::kPartLeftOut;
  const double length = largest_magnitude(ray.direction);
  if (invalid_field(ray, length) != nullptr || !is_within_range(scene.to_units(ray.origin))) {
    return {Errc::kInvalidQuery, refused_field(ray)};
  }
  SceneRayQuery query(scene, ray, stop_at_first, layers, work, exponent_of(length));
  const Errc walked = visit_nearest_instances(scene, query);
  if (walked != Errc::kOk) return walked;
  if (query.error != Errc::kOk) return query.error;
  if (!query.best.is_hit) return {};
  const RayCandidate& best = query.best;
  return SceneRayHit{{parameter_of(ray, best.t, query.parameter_exponent), best.face, best.half,
                      best.u, best.v, scene.to_world(query.best_to_units.apply(best.point())),
                      placed_normal(query.best_to_units.linear, unit_normal(best.triangle))},
                     query.best_instance};
}

}  // namespace

SceneRayResult closest_hit(const Scene& scene, const Ray& ray, LayerMask layers,
                           const QueryLimits& limits) {
  return cast(scene, ray, false, layers, limits);
}

SceneRayResult any_hit(const Scene& scene, const Ray& ray, LayerMask layers,
                       const QueryLimits& limits) {
  return cast(scene, ray, true, layers, limits);
}

}  // namespace boxtree
