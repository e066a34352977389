// SPDX-License-Identifier: MIT
// The grid of each tree of a scene: one step in the world, so that surfaces that touch still touch,
// as far as scales of instances and the profile allow.
#pragma once

#include <optional>
#include <vector>

#include "cooker/quantise/grid.h"
#include "cooker/scene/plan.h"

namespace boxtree::cooker {

/// Least number of bits over the largest extent of a mesh for which neither a tolerance nor a step
/// was stated: small objects in a large world keep their shape.
inline constexpr int kLeastMeshBits = 16;

/// The grid of each mesh that the plan keeps; empty for meshes that must not be rounded, or for
/// which no grid is fine enough. Steps are powers of two, and the origin of object space is on all
/// grids, so a coarser grid is part of a finer one. `choice`: of the step in the world; a tolerance
/// of the plan makes the step smaller or larger. Steps that tolerances decide are doubled together
/// as far as all allow (coarsen_together). `is_stated`: the caller states the step, or its bits:
/// every mesh that is not scaled takes it, whatever its size, so that borders of meshes fit.
[[nodiscard]] std::vector<std::optional<Grid>> scene_grids(const SourceScene& scene,
                                                           const ScenePlan& plan,
                                                           const GridChoice& choice,
                                                           bool is_stated);

}  // namespace boxtree::cooker
