// SPDX-License-Identifier: MIT
// A file that is gone with its owner, or with the next owner of the same name if that was killed.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <sys/types.h>

#include <boxtree/error.h>

namespace boxtree::cooker {

/// An open file in some folder. Where the file system allows (O_TMPFILE) it has no name until it is
/// given one, so that a killed process leaves nothing behind; elsewhere, and while it has a name,
/// it is called ".NAME.RANDOM.cooking", and the next TemporaryFile of that folder and name sweeps
/// what a killed process left. Not for use by several threads at once.
class TemporaryFile {
 public:
  /// Error: kWriteFailed, with the path folder/name and the cause.
  static Result<TemporaryFile> create(const std::filesystem::path& folder, std::string_view name,
                                      mode_t mode);

  TemporaryFile(TemporaryFile&& other) noexcept;
  TemporaryFile& operator=(TemporaryFile&&) = delete;
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile();

  [[nodiscard]] int descriptor() const { return descriptor_; }

  /// The name that it has, or will have.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] bool is_named() const { return is_named_; }

  /// Gives it its name if it has none. Error: kWriteFailed.
  Status add_name();
  /// Takes the name away; whoever has it open still can read and write it. Where that fails it is
  /// tried once more when the owner goes.
  void remove_name();
  /// To be called when the name has been moved: it is no longer this file's to remove.
  void release_name() { is_named_ = false; }

 private:
  TemporaryFile() = default;
  Status choose_name();
  Status create_named(mode_t mode);

  std::filesystem::path folder_;
  std::string name_;  // that of what it is for
  std::filesystem::path path_;
  bool is_named_ = false;
  int descriptor_ = -1;  // once moved from, too
};

}  // namespace boxtree::cooker
