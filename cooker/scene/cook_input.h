// SPDX-License-Identifier: MIT
// What is cooked: the scene that importers made of a file with a node graph, of the meshes and
// instances that a profile lists, or of meshes that become trees side by side.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "cooker/import/source_scene.h"
#include "cooker/scene/profile.h"

namespace boxtree::cooker {

/// Told of every step ("import bunny.obj"); may be empty.
using Progress = std::function<void(const std::string& step)>;

inline void announce(const Progress& progress, const std::string& step) {
  if (progress) progress(step);
}

/// A scene and what was imported for it, in the order of import.
struct CookInput {
  SourceScene scene;
  /// False: nothing places the meshes, and each is a tree. There are no instances, then.
  bool has_top_level = true;
  std::vector<ImportReport> imports;
  std::vector<std::string> import_names;  // of the files, as the cook record names them
  /// Imports a mesh of `scene` when it is needed, so that not all need be in memory together;
  /// called once for each, in order. Empty: all meshes are there.
  std::function<Result<Imported>(std::size_t mesh)> importer;
};

/// Loads the scene of a profile or, where that names no source and lists no meshes, of `inputs`,
/// which make one scene together. Told of every file before it is read. Errors: those of
/// import_scene; kProfileInvalid when neither or both say what to load.
Result<CookInput> load_scene(std::span<const std::filesystem::path> inputs, const Profile& profile,
                             const ImportOptions& options, const Progress& progress = {});

/// Loads a file as what it is: a scene if it places meshes twice or more, else one tree without a
/// top level. Errors: those of import_file.
Result<CookInput> load_file(const std::filesystem::path& path, const ImportOptions& options,
                            const Progress& progress = {});

/// Each input becomes a tree named after its file, without a top level. Reads nothing yet:
/// CookInput::importer does, with the errors of import_mesh. Error: kMeshTooLarge for more inputs
/// than a file holds trees.
Result<CookInput> load_trees(std::span<const std::filesystem::path> inputs,
                             const ImportOptions& options, const Progress& progress = {});

}  // namespace boxtree::cooker
