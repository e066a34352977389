// SPDX-License-Identifier: MIT
// Rays through a scene.
#include <cmath>

#include <boxtree/runtime/query/float_state.h>
#include <boxtree/runtime/query/ray_query.h>
#include <boxtree/runtime/scene/scene_queries.h>
#include <boxtree/runtime/scene/scene_walk.h>

namespace boxtree {
namespace {

// In the scene's frame, with the parameter s = t * 2^parameter_exponent (see RayQuery). Boxes of
// instances are widened by PlacementBounds::error(); what is left is the error of the ray's own
// origin on its way to object space and back, of which the slab's margin gets its share by a larger
// reach.
struct SceneRayQuery {
  SceneRayQuery(const Scene& scene, const Ray& world, bool stop_at_first, LayerMask layers) noexcept
      : admission{scene, kRayQueries, layers},
        ray(world),
        any(stop_at_first),
        exponent(direction_exponent(world.direction)),
        parameter_exponent(exponent - scene.record().scale_exponent),
        in_frame(make_in_frame(scene)),
        s_max(RayQuery::scaled(world.t_max, parameter_exponent)) {}

  [[nodiscard]] TopLevelRay make_in_frame(const Scene& scene) const noexcept {
    const Eigen::Vector3d origin = scene.frame().to_tree(ray.origin);
    const Eigen::Vector3d direction = RayQuery::scaled(ray.direction, -exponent);
    const double widened = reach(scene, ray);
    return {origin, direction, widened,
            RaySlab(origin, direction, Eigen::Vector3d::Constant(widened)),
            RayQuery::scaled(ray.t_min, parameter_exponent)};
  }

  static double reach(const Scene& scene, const Ray& world) noexcept {
    double largest = reach_of(scene.top_level());
    if (!scene.moving_tree().empty()) {
      largest = std::max(largest, reach_of(scene.moving_tree().root_box()).maxCoeff());
    }
    const double origin = world.origin.cwiseAbs().maxCoeff() * scene.frame().inverse_scale;
    return largest + 16 * scene.condition() * (origin + largest);
  }

  [[nodiscard]] bool is_done() const noexcept {
    return error != Errc::kOk || (any && best.has_value());
  }
  [[nodiscard]] double bound() const noexcept { return s_max; }
  template <class S>
  [[nodiscard]] double key(const Box<S>& box) const noexcept {
    return in_frame.slab.key(box, in_frame.s_min);
  }
  [[nodiscard]] Errc walk(const TopLevel& top, InstanceVisitor instances) const {
    return walk_top_level(top, instances, in_frame, s_max);
  }

  [[nodiscard]] bool visit(std::uint32_t instance, const Scene::Placed& placed) {
    const Result<std::optional<RayHit>> found =
        cast_ray(*placed.tree, placed.placement.to_object(ray), any);
    if (!found) {
      error = found.code();
      return false;
    }
    if (!*found) return true;
    const RayHit& hit = **found;
    if (best && hit.t == best->hit.t && placed.id >= best_id) return true;
    best = SceneRayHit{hit, instance};
    best_id = placed.id;
    ray.t_max = hit.t;
    s_max = RayQuery::scaled(hit.t, parameter_exponent);
    return !is_done();
  }

  Admission admission;
  Ray ray;  // t_max shrinks to the best hit
  bool any;
  int exponent;
  int parameter_exponent;
  TopLevelRay in_frame;
  double s_max;
  std::optional<SceneRayHit> best;
  std::uint32_t best_id = 0;
  Errc error = Errc::kOk;
};

Result<std::optional<SceneRayHit>> cast(const Scene& scene, const Ray& ray, bool stop_at_first,
                                        LayerMask layers) {
  const DefaultFloatState state;
  if ((scene.query_kinds() & kRayQueries) == 0) return Errc::kPartLeftOut;
  if (!is_valid(ray) || !is_within_reach(scene.frame().to_tree(ray.origin))) {
    return Errc::kInvalidQuery;
  }
  SceneRayQuery query(scene, ray, stop_at_first, layers);
  const Errc walked = walk_nearest(scene, query);
  if (walked != Errc::kOk) return walked;
  if (query.error != Errc::kOk) return query.error;
  return query.best;
}

}  // namespace

Result<std::optional<SceneRayHit>> closest_hit(const Scene& scene, const Ray& ray,
                                               LayerMask layers) {
  return cast(scene, ray, false, layers);
}

Result<std::optional<SceneRayHit>> any_hit(const Scene& scene, const Ray& ray, LayerMask layers) {
  return cast(scene, ray, true, layers);
}

}  // namespace boxtree
