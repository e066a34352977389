// SPDX-License-Identifier: MIT
// A scene through all stages: load -> plan -> build -> encode -> choose -> write, and the account
// of what was kept and what was left out.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "cooker/cook.h"
#include "cooker/scene/plan.h"

namespace boxtree::cooker {

/// One line of --why: a part of the file, or one that is not in it.
struct WhyLine {
  std::string part;   // "vertices"
  std::string owner;  // "mesh crate"; "file"
  bool kept = true;
  std::uint64_t bytes = 0;   // in the file, or that it would have taken
  bool is_estimate = false;  // of something that was never made
  std::string reason;
  std::string line;  // of the profile, cited; empty where a default decided
};

struct SceneReport {
  CookReport cook;  // trees in the order of the file
  std::uint32_t instances = 0;
  std::uint32_t moving = 0;
  std::uint32_t instances_left_out = 0;
  std::uint32_t meshes = 0;  // of the source, before any was left out
  std::uint64_t placed_triangles = 0;
  std::uint64_t file_bytes = 0;
  std::vector<WhyLine> why;  // the bytes of what was kept add up to file_bytes
  std::vector<std::string> notices;
  std::vector<std::filesystem::path> files_read;  // beside those of the imports
};

/// Cooks one scene and writes and proves the file. `inputs` are empty when the profile says what to
/// cook. Where both say something, options.codec, geometry, grid and face_ids stand above the
/// profile's [scene], below what it says of single objects. On any error nothing of `output`
/// changes. The bytes written do not depend on threads or folders.
/// Errors: those of load_scene, plan_scene, try_encodings and write_file; kBudgetUnreachable,
/// naming the nearest that is possible.
Result<SceneReport> cook_scene(std::span<const std::filesystem::path> inputs,
                               const std::filesystem::path& output, const CookOptions& options,
                               const Profile& profile, const Progress& progress = {});

using CookedFile = std::variant<CookReport, SceneReport>;

/// Cooks one file as what it is: a scene if it places meshes twice or more (import_file), otherwise
/// one tree.
Result<CookedFile> cook_file(const std::filesystem::path& input,
                             const std::filesystem::path& output, const CookOptions& options,
                             const Progress& progress = {});

}  // namespace boxtree::cooker
