// SPDX-License-Identifier: MIT
// A file that appears complete or not at all: the target does not change before commit().
#pragma once

#include <filesystem>
#include <optional>

#include <boxtree/error.h>

#include "cooker/write/output_target.h"
#include "cooker/write/temporary_file.h"
#include "format/bytes.h"

namespace boxtree::cooker {

/// The file that a chain of symbolic links leads to, whether it exists or not; `target` itself if
/// it is not a link. Error: kWriteFailed for a loop.
Result<std::filesystem::path> follow_links(const std::filesystem::path& target);

/// The folder that a file is in, "." for a name alone.
[[nodiscard]] std::filesystem::path folder_of(const std::filesystem::path& target);

/// Collects bytes in a TemporaryFile beside the target and renames it to the target. Files left by
/// a killed process are removed by the next AtomicFile for the same target. If the target is a
/// link, the file that it leads to is replaced. An existing file keeps its mode, and its owner if
/// the process may set owners. Two processes may write one target; the last one wins. Not for use
/// by several threads at once.
///
/// The bytes for a stream are collected in memory, and commit() writes them to it: all of them or,
/// if an error comes before, none. Nothing but the stream is touched.
class AtomicFile {
 public:
  /// Error: kWriteFailed, as for all other functions; the detail has the path and the cause.
  static Result<AtomicFile> create(const OutputTarget& to);

  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  /// Without commit(), everything written is discarded.
  ~AtomicFile();

  Status write(Bytes bytes);

  /// The descriptor, to read what was written before commit().
  [[nodiscard]] int descriptor() const { return temporary_.descriptor(); }

  /// Whether commit() would replace a file that has bytes, and not the same as the new one.
  [[nodiscard]] bool loses_bytes() const;

  /// Makes the bytes durable and moves them to the target: fsync, rename, fsync of the directory;
  /// on Windows FlushFileBuffers, ReplaceFile, and descriptor() is closed then. After an error the
  /// target is the old file, or missing if there was none. A stream may have taken a part of the
  /// bytes.
  Status commit();

 private:
  AtomicFile(TemporaryFile temporary, std::filesystem::path target, bool replaces);

  static Result<AtomicFile> create_beside(const std::filesystem::path& given);
  Status replace_target();
  [[nodiscard]] Status send() const;

  TemporaryFile temporary_;
  std::filesystem::path target_;
  std::optional<OutputStream> stream_;
  bool replaces_;       // whether the target existed
  int directory_ = -1;  // also after a move
};

}  // namespace boxtree::cooker
