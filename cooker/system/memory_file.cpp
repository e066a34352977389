// SPDX-License-Identifier: MIT
#include "cooker/system/memory_file.h"

#ifdef _WIN32
#include <array>
#include <cerrno>
#include <fcntl.h>
#include <io.h>

#include "runtime/file/windows_path.h"
#elif defined(__linux__)
#include <sys/mman.h>
#else
#include <cstdio>
#include <fcntl.h>
#endif

namespace boxtree::cooker {

int open_memory_file() noexcept {
#ifdef _WIN32
  std::array<wchar_t, MAX_PATH + 1> folder{};
  std::array<wchar_t, MAX_PATH> name{};
  // A share for those who map it. It is written to the disk only where memory is short.
  constexpr DWORD kShare = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;
  constexpr DWORD kKind = FILE_ATTRIBUTE_TEMPORARY | FILE_FLAG_DELETE_ON_CLOSE;
  HANDLE file = INVALID_HANDLE_VALUE;
  if (::GetTempPathW(MAX_PATH, folder.data()) != 0 &&
      ::GetTempFileNameW(folder.data(), L"bxt", 0, name.data()) != 0) {
    file = ::CreateFileW(name.data(), GENERIC_READ | GENERIC_WRITE, kShare, nullptr,
                         TRUNCATE_EXISTING, kKind, nullptr);
  }
  const int descriptor =
      file == INVALID_HANDLE_VALUE
          ? -1
          : ::_open_osfhandle(reinterpret_cast<std::intptr_t>(file), _O_RDWR | _O_BINARY);
  if (descriptor < 0) errno = EACCES;
  return descriptor;
#elif defined(__linux__)
  return ::memfd_create("boxtree", MFD_CLOEXEC);
#else
  // Not tested: macOS and others.
  std::FILE* const file = std::tmpfile();
  if (file == nullptr) return -1;
  const int descriptor = ::fcntl(::fileno(file), F_DUPFD_CLOEXEC, 0);
  static_cast<void>(std::fclose(file));
  return descriptor;
#endif
}

}  // namespace boxtree::cooker
