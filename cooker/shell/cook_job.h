// SPDX-License-Identifier: MIT
// The one shell around the pipeline: reads what a job names, cooks it in memory, checks that
// nothing that was read would be written over, and writes.
#pragma once

#include <filesystem>
#include <vector>

#include "cooker/cook.h"

namespace boxtree::cooker {

/// One output and all that it is made of; a path that was not given is empty.
struct CookJob {
  std::vector<std::filesystem::path> inputs;  // may be empty where the profile says what to cook
  std::filesystem::path output;
  std::filesystem::path profile = {};  // a scene.toml; makes the inputs one scene
  std::filesystem::path costs = {};    // constants of the user's machine
  std::filesystem::path depfile = {};  // to write: all files that were read, in make syntax
  bool as_scene = false;               // make the inputs one scene
  bool flatten = false;                // make each input one tree, never a scene
  CookOptions options = {};
};

/// What can be said of a job before anything is read: whether the output has a name, and whether it
/// or the depfile is an input or both are one file. Error: kWriteFailed.
Status check_job(const CookJob& job);

/// Cooks a job: a scene, where it says so or its only input places meshes twice or more; otherwise
/// each input becomes a tree named after its file. Each input is imported once; inputs that share a
/// grid are in memory together, others one after the other. The file is written, proven and takes
/// the place of another only when it is whole; before it the depfile. On any error nothing of the
/// output changes. The bytes do not depend on threads or folders. Errors: those of check_job;
/// kWriteFailed, also where an output is a file that was read; those of read_costs, read_profile,
/// load_scene, load_file, load_trees, cook and write_file.
Result<Summary> cook_job(const CookJob& job, const Progress& progress = {});

}  // namespace boxtree::cooker
