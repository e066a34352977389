// SPDX-License-Identifier: MIT
// What `boxtree info` says of a scene.
#pragma once

#include <cstdint>

#include <boxtree/file.h>
#include <boxtree/scene.h>

#include "cooker/cli/json_output.h"

namespace boxtree::cooker {

/// Counts, instances, layers, materials and what was left out; null for a file without a scene.
/// Errors: those of Scene::bind.
Result<Json> scene_json(const File& file);

/// Instances of the source that are not in the file, as far as it shows: ids are numbers in the
/// source, so those before the last instance in the file leave gaps.
[[nodiscard]] std::uint32_t instances_left_out(const Scene& scene);

/// Whether the file names a line of a profile that left something out.
[[nodiscard]] bool profile_left_out(const File& file);

/// The kinds of queries that instances of a layer answer. Precondition: an instance is in it.
[[nodiscard]] QueryKinds layer_queries(const Scene& scene, std::uint32_t layer);

void print_scene(const Json& scene);

}  // namespace boxtree::cooker
