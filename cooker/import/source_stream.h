// SPDX-License-Identifier: MIT
// A source file, read once from front to back and hashed while it is read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <boxtree/error.h>

#include "cooker/import/source_file.h"
#include "cooker/system/file_handle.h"
#include "runtime/file/checksum_stream.h"

namespace boxtree::cooker {

/// Not a mapping: a file that shrinks meanwhile ends early instead of raising SIGBUS, and pages
/// that were read do not count as the process's memory.
class SourceStream {
 public:
  /// The most that `take` returns at once, and that `ahead` returns of a longer file.
  static constexpr std::size_t kBufferBytes = std::size_t{1} << 18;

  static Result<SourceStream> open(const SourceFile& source);

  /// The part of the file in memory and not yet taken: at the start kBufferBytes, or the whole
  /// file.
  [[nodiscard]] std::string_view ahead() const {
    return {at_, static_cast<std::size_t>(end_ - at_)};
  }

  /// Bytes not yet taken.
  [[nodiscard]] std::uint64_t left() const {
    return unread_ + static_cast<std::uint64_t>(end_ - at_);
  }

  /// The next `count` bytes, valid until the next call; nullptr if fewer are left. Precondition:
  /// count <= kBufferBytes.
  [[nodiscard]] const char* take(std::size_t count) {
    if (static_cast<std::size_t>(end_ - at_) < count && !refill(count)) return nullptr;
    const char* const bytes = at_;
    at_ += count;
    return bytes;
  }

  /// All remaining bytes. Errors: as ended_in.
  [[nodiscard]] Result<std::string> take_rest();

  /// Skips `count` bytes; false if fewer are left.
  [[nodiscard]] bool skip(std::uint64_t count);

  /// The error after `take` or `skip` failed: the file cannot be read, or ends too early.
  [[nodiscard]] Error ended_in(std::string_view what) const;

  /// Reads the rest; returns XXH3 (64 bits) of the whole file.
  Result<std::uint64_t> finish();

 private:
  SourceStream() = default;
  bool refill(std::size_t count);

  std::string title_;
  FileHandle file_;
  ChecksumStream sum_;  // of what was in the buffer
  std::vector<char> buffer_;
  const char* at_ = nullptr;
  const char* end_ = nullptr;
  std::uint64_t unread_ = 0;  // bytes of the file that are not in the buffer yet
  int error_ = 0;             // of the system, if reading failed
};

}  // namespace boxtree::cooker
