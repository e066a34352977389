// SPDX-License-Identifier: MIT
#include "cooker/farm/job_files.h"

#include <algorithm>
#include <utility>

#include "cooker/import/import.h"
#include "cooker/scene/cook_input.h"
#include "cooker/scene/profile.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

Status add_mesh(const fs::path& mesh, const ImportOptions& options, const ListFiles& list_files,
                std::vector<JobFile>& files) {
  Result<std::vector<fs::path>> read = list_files(mesh, options);
  if (!read) return read.error();
  FileRole role = FileRole::kMesh;
  for (fs::path& file : *read) {
    files.push_back({std::exchange(role, FileRole::kReferred), std::move(file)});
  }
  return {};
}

}  // namespace

Result<std::vector<JobFile>> list_job_files(const CookJob& job, const ListFiles& list_files) {
  std::vector<JobFile> files;
  std::vector<fs::path> meshes = job.inputs;
  if (!job.profile.empty()) {
    Result<Profile> profile = read_profile(job.profile);
    if (!profile) return profile.error();
    FileRole role = FileRole::kProfile;
    for (fs::path& file : profile->files_read) {
      files.push_back({std::exchange(role, FileRole::kHiddenFaces), std::move(file)});
    }
    Result<std::vector<fs::path>> named = scene_files(job.inputs, *profile);
    if (!named) return named.error();
    meshes = std::move(*named);
  }
  for (const fs::path& mesh : meshes) {
    if (Status status = add_mesh(mesh, job.options.import, list_files, files); !status) {
      return status.error();
    }
  }
  if (!job.costs.empty()) files.push_back({FileRole::kCosts, job.costs});
  return files;
}

}  // namespace boxtree::cooker
