// SPDX-License-Identifier: MIT
// How fine the grid of each tree of a scene is: one step in the world, so that what touches still
// does, as far as scales of instances and wishes of the profile allow.
#pragma once

#include <optional>
#include <vector>

#include "cooker/quantise/grid.h"
#include "cooker/scene/plan.h"

namespace boxtree::cooker {

/// Steps of which a mesh has no fewer over its largest extent when nobody stated a tolerance: a
/// small thing in a large world keeps its shape.
inline constexpr int kLeastMeshBits = 16;

/// The grid of each mesh that the plan keeps; nothing for meshes that must not be rounded, or that
/// no grid is fine enough for. Steps are powers of two and all grids have the origin of object
/// space on them: a coarser one is part of a finer one. By default `bits` steps over the scene's
/// largest extent in the world; a tolerance of the plan makes the step smaller or larger.
[[nodiscard]] std::vector<std::optional<Grid>> scene_grids(const SourceScene& scene,
                                                           const ScenePlan& plan, int bits);

}  // namespace boxtree::cooker
