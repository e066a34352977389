// SPDX-License-Identifier: MIT
// The part of a plan that is about meshes.
#pragma once

#include "cooker/scene/plan.h"

namespace boxtree::cooker {

/// Fills meshes and material_names of a plan whose instances and layers are there, and adds what
/// is decided. Errors as of plan_scene.
Status plan_meshes(const SourceScene& scene, const Profile& profile, ScenePlan& plan);

}  // namespace boxtree::cooker
