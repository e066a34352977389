// SPDX-License-Identifier: MIT
// Compiled elsewhere, this is nothing.
#ifdef _WIN32
#include "runtime/file/windows_path.h"

#include <cerrno>
#include <cstddef>
#include <limits>
#include <system_error>

#include "runtime/file/read_failure.h"

namespace boxtree {

std::wstring wide_path(const std::string& path) {
  if (path.empty() || path.size() > std::size_t{std::numeric_limits<int>::max()}) return {};
  const int bytes = static_cast<int>(path.size());
  const int size =
      ::MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path.data(), bytes, nullptr, 0);
  if (size <= 0) return {};
  std::wstring wide(static_cast<std::size_t>(size), L'\0');
  ::MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path.data(), bytes, wide.data(), size);
  if (wide.find(L'\0') != std::wstring::npos) return {};
  const bool is_taken_as_it_is = wide.starts_with(L"\\\\?\\") || wide.starts_with(L"\\\\.\\");
  if (is_taken_as_it_is) return wide;
  // The system counts with the current folder, and leaves room for a short name in a new folder.
  constexpr DWORD kRoomInFolders = 12;
  const DWORD full_size = ::GetFullPathNameW(wide.c_str(), 0, nullptr, nullptr);
  if (full_size <= MAX_PATH - kRoomInFolders) return wide;
  std::wstring full(full_size, L'\0');  // with a 0 at its end
  full.resize(::GetFullPathNameW(wide.c_str(), full_size, full.data(), nullptr));
  if (full.starts_with(L"\\\\")) return L"\\\\?\\UNC\\" + full.substr(2);
  return L"\\\\?\\" + full;
}

Error windows_error(Errc code, const std::string& path, DWORD reason) {
  switch (reason) {
    case ERROR_FILE_NOT_FOUND:
    case ERROR_PATH_NOT_FOUND:
    case ERROR_INVALID_NAME:
    case ERROR_BAD_NETPATH:
    case ERROR_BAD_NET_NAME:
    case ERROR_INVALID_DRIVE:
      return read_failure(path, ENOENT);
    case ERROR_NOT_ENOUGH_MEMORY:
    case ERROR_OUTOFMEMORY:
    case ERROR_COMMITMENT_LIMIT:
      return read_failure(path, ENOMEM);
    default:
      return Error{code, path + ": " + std::system_category().message(static_cast<int>(reason))};
  }
}

}  // namespace boxtree
#endif
