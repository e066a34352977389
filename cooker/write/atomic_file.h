// SPDX-License-Identifier: MIT
// A file that appears whole or not at all: nothing under its name changes before commit().
#pragma once

#include <filesystem>

#include <boxtree/error.h>

#include "cooker/write/temporary_file.h"
#include "format/bytes.h"

namespace boxtree::cooker {

/// The file that a chain of symbolic links leads to, be it there or not; `target` itself if it is
/// no link. Error: kWriteFailed for a loop.
Result<std::filesystem::path> follow_links(const std::filesystem::path& target);

/// Collects bytes in a TemporaryFile beside the target and puts them in its place by rename: what a
/// killed process leaves, the next AtomicFile for the same target sweeps. A target that is a link
/// stays one: what it leads to is replaced. An existing file keeps its mode, and its owner where
/// the process may give files away. Two processes that write one target do not hinder each other:
/// the last one stays. Not for use by several threads at once.
class AtomicFile {
 public:
  /// Error: kWriteFailed, as for all that follow; the detail names the path and the cause.
  static Result<AtomicFile> create(const std::filesystem::path& given);

  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  /// Without commit(), everything written is discarded.
  ~AtomicFile();

  Status write(Bytes bytes);

  /// The descriptor, for reading back what was written before it is committed.
  [[nodiscard]] int descriptor() const { return temporary_.descriptor(); }

  /// Makes the bytes durable and moves them to the target: fsync, rename, fsync of the directory.
  /// After an error the old file is in its place, or none if there was none.
  Status commit();

 private:
  AtomicFile(TemporaryFile temporary, std::filesystem::path target, bool replaces);

  TemporaryFile temporary_;
  std::filesystem::path target_;
  bool replaces_;       // whether the target was there
  int directory_ = -1;  // once moved from, too
};

}  // namespace boxtree::cooker
