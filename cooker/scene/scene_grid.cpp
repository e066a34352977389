// SPDX-License-Identifier: MIT
// Steps of grids from the scene's extent, scales of instances and tolerances.
#include <algorithm>
#include <cmath>

#include <boxtree/cooker/scene/scene_grid.h>
#include <boxtree/format/grid.h>

namespace boxtree::cooker {
namespace {

// Corners of boxes through poses, one product and sum after the other: the result goes into files.
Eigen::AlignedBox3d world_bounds(const SourceScene& scene, const ScenePlan& plan,
                                 const std::vector<Eigen::AlignedBox3d>& mesh_bounds) {
  Eigen::AlignedBox3d world;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const SceneInstance& instance = scene.instances[i];
    const Eigen::AlignedBox3d& box = mesh_bounds[instance.mesh];
    if (!plan.instances[i].kept || box.isEmpty()) continue;
    Eigen::Vector3d low, high;
    for (Eigen::Index k = 0; k < 3; ++k) {
      low[k] = high[k] = instance.pose.translation()[k];
      for (Eigen::Index j = 0; j < 3; ++j) {
        const double factor = instance.pose.linear()(k, j);
        const double a = factor * box.min()[j], b = factor * box.max()[j];
        low[k] += std::min(a, b);
        high[k] += std::max(a, b);
      }
    }
    world.extend(low);
    world.extend(high);
  }
  return world;
}

// The smallest e with 2^e >= x; x is positive.
int exponent_above(double x) {
  int exponent = 0;
  return std::frexp(x, &exponent) == 0.5 ? exponent - 1 : exponent;
}

}  // namespace

std::vector<std::optional<Grid>> scene_grids(const SourceScene& scene, const ScenePlan& plan,
                                             int bits) {
  std::vector<Eigen::AlignedBox3d> bounds;
  for (const SceneMesh& mesh : scene.meshes) bounds.push_back(bounds_of(mesh.mesh));
  const Result<Grid> of_scene =
      choose_grid(world_bounds(scene, plan, bounds), {bits, std::nullopt});
  std::vector<std::optional<Grid>> grids(scene.meshes.size());
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    const PlannedMesh& mesh = plan.meshes[m];
    if (!mesh.kept || mesh.exact || mesh.external || !of_scene) continue;
    std::optional<Grid> grid;
    const auto take_finer = [&](const Result<Grid>& other) {
      if (!other) return false;
      if (!grid || other->step_exponent < grid->step_exponent) grid = *other;
      return true;
    };
    bool is_possible = true;
    if (mesh.tolerance) {
      is_possible = take_finer(choose_grid(bounds[m], {bits, mesh.tolerance}));
    }
    if (mesh.default_precision || !mesh.tolerance) {
      is_possible &= take_finer(choose_grid(bounds[m], {kLeastMeshBits, std::nullopt}));
      const double scale = mesh.largest_scale > 0 ? mesh.largest_scale : 1;
      const int step = of_scene->step_exponent - exponent_above(scale);
      if (grid && step < grid->step_exponent) {
        // As fine as the scene's: by the tolerance that asks for just that step.
        is_possible &= take_finer(choose_grid(bounds[m], {bits, std::ldexp(0.8662, step)}));
      }
    }
    if (is_possible) grids[m] = grid;
  }
  return grids;
}

}  // namespace boxtree::cooker
