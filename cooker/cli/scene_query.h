// SPDX-License-Identifier: MIT
// Queries to scenes.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "cooker/cli/open_file.h"
#include "cooker/cli/query_request.h"

namespace boxtree::cooker {

/// A file and its scene.
struct OpenedScene {
  File file;
  Scene scene;
};

/// Opens the scene of a file and moves instances: each of `moves` is "INSTANCE=POSE", the instance
/// by its name or number. Errors: those of Scene::bind; kInvalidQuery for a move that says nothing.
Result<OpenedScene> open_scene(File file, std::span<const std::string> moves);

/// What to tell users of `moves` whose instance is not the only one that they may have meant: its
/// name is that of several, or the number of another one.
[[nodiscard]] std::vector<std::string> hidden_by_names(const Scene& scene,
                                                       std::span<const std::string> moves);

/// The same scene with its instances as they are in the file, but for `moves`.
Result<Scene> move_scene(const File& file, std::span<const std::string> moves);

/// The layers with these names; all of them without a name. Error: kInvalidQuery.
Result<LayerMask> layers_named(const Scene& scene, std::span<const std::string> names);

/// The answer of these layers in the form that `boxtree query --json` prints: that for a tree, and
/// the instance. Errors: kInvalidQuery for kinds that only trees answer, and of contacts for less
/// than all layers; kPartLeftOut with the line of the profile that left it out.
Result<Json> answer(const File& file, const Scene& scene, LayerMask layers,
                    const QueryRequest& request, TreeCache& others);

}  // namespace boxtree::cooker
