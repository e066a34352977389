// SPDX-License-Identifier: MIT
// Which files a mesh refers to, remembered with all that decides it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cooker/farm/file_state.h"
#include "cooker/import/import.h"
#include "cooker/text/json.h"

namespace boxtree::cooker {

struct FileList {
  std::vector<std::filesystem::path> files;                         // as list_source_files()
  std::vector<std::pair<std::filesystem::path, FileState>> opened;  // the mesh first
  std::vector<std::filesystem::path> absent;

  /// Whether the mesh refers to these files now: all that was opened has its state, and what was
  /// absent still is.
  [[nodiscard]] bool is_current() const;
};

/// What was found of a mesh by a reading that began at that time; nothing if a file may have
/// changed since unseen (FileState::is_settled), or if not all that decides it is known.
[[nodiscard]] std::optional<FileList> file_list(const std::filesystem::path& mesh,
                                                const SourceFileList& found,
                                                std::int64_t began_nanoseconds);

/// As an object with a seal, a digest over all of it and over the cooker.
[[nodiscard]] Json to_json(const FileList& list);
/// Nothing if the object is none such, is damaged or of another cooker, which may list others.
[[nodiscard]] std::optional<FileList> file_list_in(const Json& object);

}  // namespace boxtree::cooker
