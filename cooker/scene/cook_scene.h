// SPDX-License-Identifier: MIT
// A scene through all stages in memory: plan -> build -> encode -> choose, and the account of what
// was kept and what was left out.
#pragma once

#include "cooker/cook.h"
#include "cooker/scene/plan.h"
#include "cooker/scene/scene_source.h"

namespace boxtree::cooker {

/// Where both say something, options.codec, geometry, grid and face_ids stand above the profile's
/// [scene], below what it says of single objects. The bytes do not depend on threads or folders.
/// Errors: those of plan_scene, try_encodings and encode_scene; kBudgetUnreachable, naming the
/// nearest that is possible.
Result<CookedFile> cook_scene(LoadedScene source, const Profile& profile,
                              const CookOptions& options, const Progress& progress = {});

}  // namespace boxtree::cooker
