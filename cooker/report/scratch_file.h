// SPDX-License-Identifier: MIT
// A file for the length of one measurement.
#pragma once

#include <filesystem>
#include <span>

#include <boxtree/error.h>

namespace boxtree::cooker {

/// A file in the system's temporary folder without a name, gone with the process that made it. Its
/// path leads through the process's descriptors and means nothing to other processes.
class ScratchFile {
 public:
  /// Writes it. Error: kWriteFailed.
  static Result<ScratchFile> create(std::span<const std::byte> bytes);
  ~ScratchFile();
  ScratchFile(ScratchFile&& other) noexcept;
  ScratchFile& operator=(ScratchFile&&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  explicit ScratchFile(int descriptor);
  int descriptor_;  // -1 once moved from
  std::filesystem::path path_;
};

}  // namespace boxtree::cooker
