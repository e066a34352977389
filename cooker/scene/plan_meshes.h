// SPDX-License-Identifier: MIT
// Plans the meshes of a scene.
#pragma once

#include "cooker/scene/plan.h"

namespace boxtree::cooker {

/// Fills in the meshes and material_names of a plan with instances and layers, and appends the
/// decisions. Errors: as for plan_scene.
Status plan_meshes(const SourceScene& scene, const Profile& profile, ScenePlan& plan);

}  // namespace boxtree::cooker
