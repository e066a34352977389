// SPDX-License-Identifier: MIT
// A file that is removed with its owner, or, if the owner was killed, by the next owner of the same
// name.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <sys/types.h>

#include <boxtree/error.h>

namespace boxtree::cooker {

/// Of new files that others may use; the umask takes from it. (Windows gives them the rights of
/// their folder.)
inline constexpr mode_t kNewFileMode = 0666;

/// An open file in a folder. If the file system supports it (O_TMPFILE), the file has no name until
/// add_name(), so that a killed process leaves nothing behind. Otherwise, and while it has a name,
/// it is called ".NAME.RANDOM.cooking", and the next TemporaryFile with the same folder and name
/// removes files of killed processes. On Windows it always has a name. Not for use by several
/// threads at once.
class TemporaryFile {
 public:
  /// Error: kWriteFailed, with the path folder/name and the cause.
  static Result<TemporaryFile> create(const std::filesystem::path& folder, std::string_view name,
                                      mode_t mode);

  /// In memory (open_memory_file), without a folder; it cannot be given a name. Error:
  /// kWriteFailed, with `title`.
  static Result<TemporaryFile> create_in_memory(const std::string& title);

  TemporaryFile(TemporaryFile&& other) noexcept;
  TemporaryFile& operator=(TemporaryFile&&) = delete;
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile();

  [[nodiscard]] int descriptor() const { return descriptor_; }

  /// Its current or future name.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] bool is_named() const { return is_named_; }

  /// Gives the file its name if it has none. Error: kWriteFailed.
  Status add_name();
  /// Removes the name; processes that have the file open can still use it. If this fails, the
  /// destructor tries again. Windows deletes no open file, so there it is closed.
  void remove_name();
  /// Call when the name has been moved: this object no longer removes it.
  void release_name() { is_named_ = false; }
#ifdef _WIN32
  /// Closes it: what is open cannot be renamed. descriptor() is -1 then.
  void close();
#endif

 private:
  TemporaryFile() = default;
  Status choose_name();
  Status create_named(mode_t mode);

  std::filesystem::path folder_;
  std::string name_;  // of the target
  std::filesystem::path path_;
  bool is_named_ = false;
  int descriptor_ = -1;  // also after a move
};

}  // namespace boxtree::cooker
