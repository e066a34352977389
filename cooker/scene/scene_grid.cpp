// SPDX-License-Identifier: MIT
// Computes steps of grids from the scene's extent, scales of instances and tolerances.
#include "cooker/scene/scene_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "format/grid.h"
#include "runtime/query/relative_pose.h"

namespace boxtree::cooker {
namespace {

// Uses AffineMap, whose order of operations is fixed: the result goes into files.
Eigen::AlignedBox3d world_bounds(const SourceScene& scene, const ScenePlan& plan,
                                 const std::vector<Eigen::AlignedBox3d>& mesh_bounds) {
  Eigen::AlignedBox3d world;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const SceneInstance& instance = scene.instances[i];
    const Eigen::AlignedBox3d& box = mesh_bounds[instance.mesh];
    if (!plan.instances[i].kept || box.isEmpty()) continue;
    const AffineMap to_world{instance.pose.linear(), instance.pose.translation()};
    const Box<double> placed = to_world.hull(Box<double>{
        {box.min()[0], box.min()[1], box.min()[2]}, {box.max()[0], box.max()[1], box.max()[2]}});
    world.extend(Eigen::Vector3d(placed.low[0], placed.low[1], placed.low[2]));
    world.extend(Eigen::Vector3d(placed.high[0], placed.high[1], placed.high[2]));
  }
  return world;
}

}  // namespace

std::vector<std::optional<Grid>> scene_grids(const SourceScene& scene, const ScenePlan& plan,
                                             const GridChoice& choice, bool is_stated) {
  std::vector<Eigen::AlignedBox3d> bounds;
  for (const SceneMesh& mesh : scene.meshes) bounds.push_back(bounds_of(mesh.mesh));
  const Result<Grid> of_scene =
      choose_grid(world_bounds(scene, plan, bounds),
                  {.bits = choice.bits, .step_exponent = choice.step_exponent});
  std::vector<std::optional<Grid>> grids(scene.meshes.size());
  std::vector<MeshOnGrid> by_tolerance;  // those that nothing but a tolerance decides
  std::vector<std::size_t> numbers;      // their meshes
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
    int largest_step = std::numeric_limits<int>::max();  // by default
    if (mesh.tolerance) {
      const double left = tolerance_left(*mesh.tolerance, scene.meshes[m].mesh);
      is_possible = take_finer(choose_grid(bounds[m], {.tolerance = left}));
    }
    if (mesh.default_precision || !mesh.tolerance) {
      const double scale = mesh.largest_scale > 0 ? mesh.largest_scale : 1;
      const int step = of_scene->step_exponent - exponent_above(scale);
      largest_step = step;
      if (!is_stated) {
        const Result<Grid> least = choose_grid(bounds[m], {.bits = kLeastMeshBits});
        is_possible &= take_finer(least);
        if (least) largest_step = std::min(step, least->step_exponent);
      }
      if (is_possible && (!grid || step < grid->step_exponent)) {
        is_possible = take_finer(choose_grid(bounds[m], {.step_exponent = step}));
      }
    }
    if (!is_possible) continue;
    grids[m] = grid;
    if (mesh.tolerance && grid->step_exponent < largest_step) {
      by_tolerance.push_back(
          {&scene.meshes[m].mesh, bounds[m], *grid, *mesh.tolerance, largest_step});
      numbers.push_back(m);
    }
  }
  coarsen_together(by_tolerance);
  for (std::size_t i = 0; i < numbers.size(); ++i) grids[numbers[i]] = by_tolerance[i].grid;
  return grids;
}

}  // namespace boxtree::cooker
