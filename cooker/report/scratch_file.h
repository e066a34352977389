// SPDX-License-Identifier: MIT
// A file for the length of one measurement.
#pragma once

#include <filesystem>
#include <span>

#include <boxtree/format/result.h>

namespace boxtree::cooker {

/// A file in the system's temporary folder with a name that no other process uses; removed at the
/// end. One at a time in a process.
class ScratchFile {
 public:
  /// Writes it. Error: kWriteFailed.
  static Result<ScratchFile> create(std::span<const std::byte> bytes);
  ~ScratchFile();
  ScratchFile(ScratchFile&& other) noexcept;
  ScratchFile& operator=(ScratchFile&&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  explicit ScratchFile(std::filesystem::path path) : path_(std::move(path)) {}
  std::filesystem::path path_;  // empty once moved from
};

}  // namespace boxtree::cooker
