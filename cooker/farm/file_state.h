// SPDX-License-Identifier: MIT
// What the system says of a file: while it stays the same, so do the bytes.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>

namespace boxtree::cooker {

/// Device, inode, size, and the times of the last change of bytes and of anything, in nanoseconds
/// since 1970. Whoever writes to a file, or sets back the time of its bytes, sets the last one to
/// now, which no program can set to anything else.
struct FileState {
  std::array<std::uint64_t, 5> numbers{};

  bool operator==(const FileState&) const = default;

  /// Whether a later change would show, for a file that is about to be read `now`. The times of a
  /// file system come in steps (4 ms on Linux, 1 s or 2 s on some others), so that of two changes
  /// within a step the second shows nothing: what changed less than two seconds before may
  /// change again unseen. Git calls such entries of its index racy.
  [[nodiscard]] bool is_settled(std::int64_t now) const;
};

/// The state of a file, or what a link leads to; nothing if the system does not say.
[[nodiscard]] std::optional<FileState> state_of(const std::filesystem::path& file);

/// Nanoseconds since 1970.
[[nodiscard]] std::int64_t now_nanoseconds();

}  // namespace boxtree::cooker
