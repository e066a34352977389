// SPDX-License-Identifier: MIT
// Reads and writes descriptors, which POSIX and the C library of Windows have under different
// names.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#ifdef _WIN32
#include <io.h>
#else
#include <unistd.h>
#endif

#include "format/bytes.h"

namespace boxtree::cooker {

inline constexpr int kStandardInput = 0;
inline constexpr int kStandardOutput = 1;
inline constexpr int kStandardError = 2;

/// What one read or write is given at most, in bytes: macOS refuses more than 2^31 - 1, and Windows
/// has the number as an unsigned int.
inline constexpr std::size_t kMostAtATime = std::size_t{1} << 30;

/// How many bytes were read or written, which may be fewer; 0 at the end of what is read. Negative,
/// with the reason in errno, on errors, among them EINTR.
[[nodiscard]] inline std::ptrdiff_t read_some(int descriptor, std::span<std::byte> bytes) noexcept {
  const auto most = static_cast<unsigned>(std::min(bytes.size(), kMostAtATime));
#ifdef _WIN32
  return ::_read(descriptor, bytes.data(), most);
#else
  return ::read(descriptor, bytes.data(), most);
#endif
}

/// The same.
[[nodiscard]] inline std::ptrdiff_t write_some(int descriptor, Bytes bytes) noexcept {
  const auto most = static_cast<unsigned>(std::min(bytes.size(), kMostAtATime));
#ifdef _WIN32
  return ::_write(descriptor, bytes.data(), most);
#else
  return ::write(descriptor, bytes.data(), most);
#endif
}

inline void close_descriptor(int descriptor) noexcept {
#ifdef _WIN32
  static_cast<void>(::_close(descriptor));
#else
  static_cast<void>(::close(descriptor));
#endif
}

[[nodiscard]] inline bool is_terminal(int descriptor) noexcept {
#ifdef _WIN32
  return ::_isatty(descriptor) != 0;
#else
  return ::isatty(descriptor) == 1;
#endif
}

}  // namespace boxtree::cooker
