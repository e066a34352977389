// SPDX-License-Identifier: MIT
// What rays and casts in a scene share: their line in the scene's frame, and which faces of an
// instance may be hit.
#pragma once

#include <algorithm>
#include <cstdint>

#include <boxtree/scene.h>

#include "runtime/primitive/vector3.h"
#include "runtime/query/ray_query.h"
#include "runtime/scene/bound_scene.h"
#include "runtime/scene/scene_walk.h"
#include "runtime/scene/top_level_walk.h"

namespace boxtree {

/// The largest coordinate of an instance's box in the scene's frame.
[[nodiscard]] inline double largest_in_frame(const BoundScene& scene) noexcept {
  const double largest = max_abs_of(scene.top_level());
  if (scene.moving_tree().empty()) return largest;
  return std::max(largest, max_abs_of(scene.moving_tree().root_box()).maxCoeff());
}

/// A line in units of the scene, for boxes in its frame that are widened by `extent` on each side;
/// `max_abs`: of these boxes, and of what else errors grow with.
[[nodiscard]] inline TopLevelRay line_in_frame(
    const BoundScene& scene, const Ray& line, double max_abs,
    const Eigen::Vector3d& extent = Eigen::Vector3d::Zero()) noexcept {
  const Eigen::Vector3d origin = scene.to_frame(line.origin);
  RaySlab slab(origin, line.direction, max_abs);
  slab.widen(AxisLanes(extent));
  return {origin, line.direction, max_abs, slab, line.t_min, extent};
}

/// A line of the world in units of the scene, with a direction whose largest component is in
/// [1/2, 1): its parameter is t * 2^parameter_exponent.
struct LineInUnits {
  LineInUnits(const BoundScene& scene, const Ray& in_world) noexcept
      : LineInUnits(scene, in_world, exponent_of(largest_magnitude(in_world.direction))) {}

  const Ray& world;
  int parameter_exponent;
  Ray line;  // t_max shrinks to the best hit

 private:
  LineInUnits(const BoundScene& scene, const Ray& in_world, int exponent) noexcept
      : world(in_world),
        parameter_exponent(exponent - scene.record().scale_exponent),
        line{scene.to_units(world.origin),
             RayInTree::scaled(AxisLanes(world.direction), -exponent).vector(),
             RayInTree::scaled(world.t_min, parameter_exponent),
             RayInTree::scaled(world.t_max, parameter_exponent)} {}
};

/// What queries along a line compare with boxes of instances: the line in the scene's frame.
struct LineInScene : LineInUnits {
  LineInScene(const LineInUnits& in_units, const TopLevelRay& ray_in_frame) noexcept
      : LineInUnits(in_units), in_frame(ray_in_frame) {}

  template <class Tree>
  [[nodiscard]] Errc walk(const Tree& tree, InstanceVisitor instances) const {
    return walk_instances(tree, instances, in_frame, line.t_max);
  }

  TopLevelRay in_frame;
};

/// The options of a query on the tree of one instance.
class OptionsOfInstance {
 public:
  OptionsOfInstance(const SceneFaceOptions& options, std::uint32_t instance) noexcept
      : accepts_{options.filter ? &*options.filter : nullptr, instance} {
    of_tree_.back_faces = options.back_faces;
    if (options.filter) of_tree_.filter = FaceFilter(accepts_);
  }
  OptionsOfInstance(const OptionsOfInstance&) = delete;
  OptionsOfInstance& operator=(const OptionsOfInstance&) = delete;
  ~OptionsOfInstance() = default;

  [[nodiscard]] const FaceOptions& of_tree() const noexcept { return of_tree_; }

 private:
  struct Accepts {
    const SceneFaceFilter* filter;
    std::uint32_t instance;
    bool operator()(const FaceRef& face) const { return (*filter)({instance, face}); }
  };

  Accepts accepts_;  // borrowed by of_tree_
  FaceOptions of_tree_;
};

/// Which instances a ray or a cast admits.
[[nodiscard]] inline Admission admitted(const BoundScene& scene, const SceneFaceOptions& options,
                                        QueryWork& work) noexcept {
  return {scene, kRayQueries, options.layers, work,
          options.instance_filter ? &*options.instance_filter : nullptr};
}

}  // namespace boxtree
