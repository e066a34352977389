// SPDX-License-Identifier: MIT
// The input of a cook: a scene imported from a file with a node graph, the meshes and instances of
// a profile, or meshes that become separate trees.
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

/// Called with every step ("import bunny.obj"); may be empty.
using Progress = std::function<void(const std::string& step)>;

inline void announce(const Progress& progress, const std::string& step) {
  if (progress) progress(step);
}

/// A scene and the reports of its imports, in order of import.
struct CookInput {
  SourceScene scene;
  /// False if nothing places the meshes: each is a tree, and there are no instances.
  bool has_top_level = true;
  std::vector<ImportReport> imports;
  std::vector<std::string> import_names;  // of the files, for the cook record
  /// Imports a mesh of `scene` when it is needed, so that not all meshes are in memory at once;
  /// called once per mesh, in order. Empty if all meshes are in memory.
  std::function<Result<Imported>(std::size_t mesh)> importer;
};

/// The mesh files of a scene, in the order in which load_scene() reads them: those that the profile
/// names, or `inputs`. Reads nothing. Error: kProfileInvalid if neither or both state what to load.
Result<std::vector<std::filesystem::path>> scene_files(
    std::span<const std::filesystem::path> inputs, const Profile& profile);

/// Loads the scene of a profile or, if it names no source and lists no meshes, of `inputs`, which
/// together form one scene. Reports progress before each file is read. Errors: those of
/// import_scene and scene_files.
Result<CookInput> load_scene(std::span<const std::filesystem::path> inputs, const Profile& profile,
                             const ImportOptions& options, const Progress& progress = {});

/// Loads a file as a scene if it places meshes twice or more, otherwise as one tree without a top
/// level. Errors: those of import_file.
Result<CookInput> load_file(const std::filesystem::path& path, const ImportOptions& options,
                            const Progress& progress = {});

/// Makes each input a tree without a top level, named after its file. Reads nothing;
/// CookInput::importer reads, with the errors of import_mesh. Error: kMeshTooLarge for more inputs
/// than a file can hold trees.
Result<CookInput> load_trees(std::span<const std::filesystem::path> inputs,
                             const ImportOptions& options, const Progress& progress = {});

}  // namespace boxtree::cooker
