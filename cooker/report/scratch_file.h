// SPDX-License-Identifier: MIT
// A temporary file for one measurement.
#pragma once

#include <filesystem>
#include <span>

#include <boxtree/error.h>

#include "cooker/write/temporary_file.h"

namespace boxtree::cooker {

/// A file without a name in the system's temporary folder, removed with its process. Its path goes
/// through the process's descriptors and is invalid in other processes. Where the system cannot
/// make a file without a name, it has one between two system calls; the next ScratchFile removes a
/// file left by a process killed there.
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
