// SPDX-License-Identifier: MIT
// Reads and writes of a file at a place of it. Not for use by several threads at once: Windows has
// no call for both, so there the descriptor moves.
#pragma once

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <utility>

#include "cooker/system/descriptor.h"
#include "cooker/system/write_all.h"
#include "format/bytes.h"

namespace boxtree::cooker {

/// The descriptor of an open file.
[[nodiscard]] inline int descriptor_of(std::FILE* file) noexcept {
#ifdef _WIN32
  return ::_fileno(file);
#else
  return ::fileno(file);
#endif
}

/// Moves a descriptor to `offset` from the start; false, with the reason in errno, if that fails.
[[nodiscard]] inline bool move_to(int descriptor, std::uint64_t offset) noexcept {
#ifdef _WIN32
  return ::_lseeki64(descriptor, static_cast<std::int64_t>(offset), SEEK_SET) >= 0;
#else
  if (!std::in_range<off_t>(offset)) {  // it may have 32 bits
    errno = EOVERFLOW;
    return false;
  }
  return ::lseek(descriptor, static_cast<off_t>(offset), SEEK_SET) >= 0;
#endif
}

/// Writes all bytes there. False, with the reason in errno, on errors.
[[nodiscard]] inline bool write_at(int descriptor, std::uint64_t offset, Bytes bytes) noexcept {
  return move_to(descriptor, offset) && write_all(descriptor, bytes);
}

/// Reads all bytes from there. False, with the reason in errno, on errors; EIO where the file ends
/// before.
[[nodiscard]] inline bool read_at(int descriptor, std::uint64_t offset,
                                  std::span<std::byte> bytes) noexcept {
  if (!move_to(descriptor, offset)) return false;
  while (!bytes.empty()) {
    const std::ptrdiff_t got = read_some(descriptor, bytes);
    if (got < 0 && errno == EINTR) continue;
    if (got == 0) errno = EIO;
    if (got <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(got));
  }
  return true;
}

}  // namespace boxtree::cooker
