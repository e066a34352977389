// SPDX-License-Identifier: MIT
// What a run over a manifest has finished, so that one that was killed goes on where it was.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <boxtree/error.h>

#include "cooker/farm/file_list.h"
#include "cooker/farm/file_state.h"
#include "cooker/farm/sha256.h"

namespace boxtree::cooker {

/// A file of JSON lines, one added whenever an output is complete: {"output", "key", "sha256",
/// "bytes"}, one whenever a file was digested: {"file", "state", "sha256"}, and one whenever the
/// files were found that a mesh refers to: {"file", "reads", "opened", "absent", "seal"}. Of
/// several lines of an output or a file the last one of a kind counts. A line that is cut short or
/// damaged counts as none, so that its job is cooked again: a journal can only cost time. One
/// process at a time has it: a lock of the file (flock) says so. Safe for several threads.
class Journal {
 public:
  struct Entry {
    Digest key;
    Digest output;  // of the bytes of the file
    std::uint64_t bytes = 0;
  };

  /// Opens or makes the file and reads it. Errors: kWriteFailed, also while another process has it
  /// open; kFileUnreadable.
  static Result<Journal> open(const std::filesystem::path& path);

  Journal(Journal&& other) noexcept;
  Journal& operator=(Journal&&) = delete;
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;
  ~Journal();

  /// The digest of a file, read only if it is not that of an earlier call, of this run or another:
  /// see FileState. Then sets `is_remembered`. Errors: those of sha256_of_file; kWriteFailed.
  [[nodiscard]] Result<Digest> digest_of(const std::filesystem::path& file,
                                         bool* is_remembered = nullptr);

  /// The files that `find` finds of a mesh, without it if those of an earlier call, of this run or
  /// another, are still right (FileList::is_current). Then sets `is_remembered`. Errors: those of
  /// `find`; kWriteFailed.
  using FindFiles = std::function<Result<SourceFileList>()>;
  [[nodiscard]] Result<std::vector<std::filesystem::path>> files_of(
      const std::filesystem::path& mesh, const FindFiles& find, bool* is_remembered = nullptr);

  /// Whether `output` was finished with this key and is there with the bytes that were written
  /// then, by digest_of if `may_remember`, else by reading it. What was finished, or nothing.
  [[nodiscard]] std::optional<Entry> find(const std::filesystem::path& output, const Digest& key,
                                          bool may_remember = false);

  /// Adds a line. Error: kWriteFailed.
  Status add(const std::filesystem::path& output, const Entry& entry);

 private:
  Journal(std::filesystem::path path, int descriptor)
      : path_(std::move(path)), descriptor_(descriptor) {}
  struct KnownFile {
    FileState state;
    Digest digest;
  };

  void read(std::string_view text);
  Status add_line(const std::string& line);
  [[nodiscard]] std::optional<Entry> entry(const std::string& name) const;

  std::filesystem::path path_;
  int descriptor_;  // -1 after a move
  std::map<std::string, Entry> entries_;
  std::map<std::string, KnownFile> files_;
  std::map<std::string, FileList> lists_;
  std::unique_ptr<std::mutex> mutex_ = std::make_unique<std::mutex>();  // of those above
};

}  // namespace boxtree::cooker
