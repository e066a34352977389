// SPDX-License-Identifier: MIT
// What `boxtree info` says of a scene.
#pragma once

#include <boxtree/file.h>

#include "cooker/cli/json_output.h"

namespace boxtree::cooker {

/// Counts, instances, layers, materials and what was left out; null for a file without a scene.
/// Errors: those of Scene::bind.
Result<Json> scene_json(const File& file);

void print_scene(const Json& scene);

}  // namespace boxtree::cooker
