// SPDX-License-Identifier: MIT
// Runs the pipeline on files: reads the inputs of a job, cooks them in memory, checks that no input
// would be overwritten, and writes the output.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "cooker/cook.h"
#include "cooker/write/output_target.h"

namespace boxtree::cooker {

/// One output and its inputs; paths that are not given are empty.
struct CookJob {
  /// May be empty if the profile states the input; options.import.bytes may stand in for one.
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path output;
  /// [none] Takes what would be written to `output`, which is then no file.
  std::optional<OutputStream> output_stream = {};
  std::filesystem::path profile = {};  // a scene.toml; makes the inputs one scene
  std::filesystem::path costs = {};    // constants of the user's machine
  std::filesystem::path depfile = {};  // to write: all files that were read, in make syntax
  /// To write: the only input, an OBJ, PLY or glTF file, with its faces in the order of its tree.
  std::filesystem::path reordered = {};
  bool as_scene = false;       // make the inputs one scene
  bool flatten = false;        // make each input one tree, never a scene
  bool require_files = false;  // refuse a mesh that names a file that is not there
  CookOptions options = {};
};

/// Checks a job before anything is read: the output must have a name, outputs must differ, and none
/// may be an input, or one of `others` that it reads. Errors: kWriteFailed; kMeshUnsupported for a
/// reordered mesh of several inputs or a scene, and as check_reordered_names.
Status check_job(const CookJob& job, std::span<const std::filesystem::path> others = {});

/// Cooks a job: a scene if as_scene is set or the only input places meshes twice or more; otherwise
/// each input becomes a tree named after its file. Each input is imported once. Inputs that share a
/// grid are in memory together, others one after another. The output is written, proven and then
/// renamed over the old file; the depfile is written before it. On any error the output is
/// unchanged. A reordered mesh is written before the output and renamed after it. The bytes do not
/// depend on threads or folders. Errors: those of check_job; kWriteFailed, also if an output is a
/// file that was read; those of read_costs, read_profile, load_scene, load_file, load_trees, cook
/// and write_file.
Result<Summary> cook_job(const CookJob& job, const Progress& progress = {});

}  // namespace boxtree::cooker
