// SPDX-License-Identifier: MIT
// A temporary file for one measurement.
#pragma once

#include <filesystem>
#include <span>

#include <boxtree/error.h>

#include "cooker/write/temporary_file.h"

namespace boxtree::cooker {

/// A file in memory that can be opened and mapped like any other. Its path goes through the
/// process's descriptors and is invalid in other processes. What is measured on it is not changed
/// by the disk: times are of cached pages anyway, and pages are counted by reads of memory.
class ScratchFile {
 public:
  /// Writes it. Errors: kWriteFailed; kFeatureUnsupported on other systems than Linux.
  static Result<ScratchFile> create(std::span<const std::byte> bytes);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  explicit ScratchFile(TemporaryFile file);
  TemporaryFile file_;
  std::filesystem::path path_;
};

}  // namespace boxtree::cooker
