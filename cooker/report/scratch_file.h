// SPDX-License-Identifier: MIT
// A file for the length of one measurement.
#pragma once

#include <filesystem>
#include <span>

#include <boxtree/error.h>

#include "cooker/write/temporary_file.h"

namespace boxtree::cooker {

/// A file in the system's temporary folder without a name, gone with the process that made it. Its
/// path leads through the process's descriptors and means nothing to other processes. Where a file
/// cannot be made without a name it has one between two system calls; what a process killed there
/// leaves, the next ScratchFile sweeps.
class ScratchFile {
 public:
  /// Writes it. Error: kWriteFailed.
  static Result<ScratchFile> create(std::span<const std::byte> bytes);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  explicit ScratchFile(TemporaryFile file);
  TemporaryFile file_;
  std::filesystem::path path_;
};

}  // namespace boxtree::cooker
