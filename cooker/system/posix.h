// SPDX-License-Identifier: MIT
// What Linux has beyond POSIX, and in its place what other systems have: macOS, the BSDs. The
// latter are not tested. On Windows this is nothing.
#pragma once

#ifndef _WIN32
#include <array>
#include <cerrno>
#include <cstdio>
#include <fcntl.h>
#include <unistd.h>
#ifdef __APPLE__
#include <crt_externs.h>
#include <sys/random.h>
#endif

namespace boxtree::cooker {

/// A pipe whose ends programs that are started do not inherit; false, with the reason in errno, if
/// there is none.
[[nodiscard]] inline bool open_pipe(std::array<int, 2>& ends) noexcept {
#ifdef __linux__
  return ::pipe2(ends.data(), O_CLOEXEC) == 0;
#else
  // A program that another thread starts in between inherits them.
  if (::pipe(ends.data()) != 0) return false;
  return ::fcntl(ends[0], F_SETFD, FD_CLOEXEC) == 0 && ::fcntl(ends[1], F_SETFD, FD_CLOEXEC) == 0;
#endif
}

/// Writes what was written to the disk itself.
[[nodiscard]] inline bool flush_to_disk(int descriptor) noexcept {
#ifdef F_FULLFSYNC  // macOS, whose fsync leaves it in the disk's memory; not all file systems have
                    // it
  if (::fcntl(descriptor, F_FULLFSYNC) == 0) return true;
#endif
  return ::fsync(descriptor) == 0;
}

/// Exchanges the names of two files at once. False, with the reason in errno; ENOSYS where the
/// system cannot.
[[nodiscard]] inline bool exchange_names(const char* a, const char* b) noexcept {
#ifdef __linux__
  return ::renameat2(AT_FDCWD, a, AT_FDCWD, b, RENAME_EXCHANGE) == 0;
#elif defined(__APPLE__)
  return ::renamex_np(a, b, RENAME_SWAP) == 0;
#else
  static_cast<void>(a);
  static_cast<void>(b);
  errno = ENOSYS;
  return false;
#endif
}

/// Opens a file of that folder that has no name; -1 where the system or the file system cannot.
[[nodiscard]] inline int open_unnamed(const char* folder, mode_t mode) noexcept {
#ifdef O_TMPFILE
  return ::open(folder, O_TMPFILE | O_RDWR | O_CLOEXEC, mode);
#else
  static_cast<void>(folder);
  static_cast<void>(mode);
  return -1;
#endif
}

/// Gives that file a name; false, with the reason in errno.
[[nodiscard]] inline bool name_unnamed(int descriptor, const char* path) noexcept {
#ifdef O_TMPFILE
  // By its descriptor, which needs a privilege, or by /proc.
  if (::linkat(descriptor, "", AT_FDCWD, path, AT_EMPTY_PATH) == 0) return true;
  std::array<char, 32> self{};
  static_cast<void>(std::snprintf(self.data(), self.size(), "/proc/self/fd/%d", descriptor));
  return ::linkat(AT_FDCWD, self.data(), AT_FDCWD, path, AT_SYMLINK_FOLLOW) == 0;
#else
  static_cast<void>(descriptor);
  static_cast<void>(path);
  errno = ENOSYS;
  return false;
#endif
}

/// What a program that is started gets as its environment.
[[nodiscard]] inline char** environment() noexcept {
#ifdef __APPLE__
  return *::_NSGetEnviron();
#else
  return environ;
#endif
}

}  // namespace boxtree::cooker
#endif
