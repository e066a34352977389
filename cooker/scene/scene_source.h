// SPDX-License-Identifier: MIT
// What a scene is cooked from: a file with a node graph, or the meshes and instances that a profile
// lists.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "cooker/import/source_scene.h"
#include "cooker/scene/profile.h"

namespace boxtree::cooker {

/// A scene and what was imported for it, in the order of import.
struct LoadedScene {
  SourceScene scene;
  std::vector<ImportReport> imports;
  std::vector<std::string> import_names;  // of the files, without folders
};

/// Loads the scene of a profile or, where that names no source and lists no meshes, of `inputs`,
/// which make one scene together. Told of every file before it is read. Errors: those of
/// import_scene; kProfileInvalid when neither or both say what to load.
Result<LoadedScene> load_scene(std::span<const std::filesystem::path> inputs,
                               const Profile& profile, const ImportOptions& options,
                               const std::function<void(const std::string&)>& progress);

}  // namespace boxtree::cooker
