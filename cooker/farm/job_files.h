// SPDX-License-Identifier: MIT
// The files that a cook reads, found without cooking: what a key is made of.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include <boxtree/error.h>

#include "cooker/shell/cook_job.h"

namespace boxtree::cooker {

/// What a file is for a job.
enum class FileRole {
  kProfile,
  kHiddenFaces,  // a list that the profile names
  kMesh,         // an input, or a mesh that the profile names
  kReferred,     // by the mesh before it: a buffer, a material library
  kCosts,
};

struct JobFile {
  FileRole role;
  std::filesystem::path path;
};

/// How the files of a mesh are listed: as list_source_files().
using ListFiles = std::function<Result<std::vector<std::filesystem::path>>(
    const std::filesystem::path& mesh, const ImportOptions& options)>;

/// All files that cook_job reads, in the order of Summary::files_read. What a mesh refers to is
/// found as import finds it, by `list_files`. A mesh that is bytes has no file and
/// is not listed. Errors: those of read_profile, scene_files and list_source_files.
Result<std::vector<JobFile>> list_job_files(const CookJob& job,
                                            const ListFiles& list_files = list_source_files);

}  // namespace boxtree::cooker
