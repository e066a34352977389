// SPDX-License-Identifier: MIT
#include "cooker/system/path.h"

#ifdef _WIN32
#include <algorithm>
#include <limits>
#include <string>

#include "runtime/file/windows_path.h"
#endif

namespace boxtree::cooker {

namespace fs = std::filesystem;

#ifdef _WIN32
namespace {

// Named by errno, as the functions of the C++ library do it there: what messages are made of.
std::error_code last_error() {
  const DWORD reason = ::GetLastError();
  const bool is_missing = reason == ERROR_FILE_NOT_FOUND || reason == ERROR_PATH_NOT_FOUND ||
                          reason == ERROR_INVALID_NAME;
  if (is_missing) return std::make_error_code(std::errc::no_such_file_or_directory);
  return {static_cast<int>(reason), std::system_category()};
}

// Whether the system takes the name as it is, so that the C++ library does.
bool is_short(const fs::path& path) {
  return !wide_path(path.string()).starts_with(L"\\\\?\\");
}

// A file or a folder, opened for its kind and size alone.
class Named {
 public:
  explicit Named(const fs::path& path)
      : handle_(::CreateFileW(wide_path(path.string()).c_str(), 0,
                              FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, nullptr,
                              OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, nullptr)) {}
  Named(const Named&) = delete;
  Named& operator=(const Named&) = delete;
  ~Named() {
    if (handle_ != INVALID_HANDLE_VALUE) ::CloseHandle(handle_);
  }
  // False, with the reason in `error`.
  [[nodiscard]] bool read(BY_HANDLE_FILE_INFORMATION& found, std::error_code& error) const {
    error.clear();
    if (handle_ != INVALID_HANDLE_VALUE && ::GetFileInformationByHandle(handle_, &found) != 0) {
      return true;
    }
    error = last_error();
    return false;
  }

 private:
  HANDLE handle_;
};

}  // namespace

// What is longer than an int can say is longer than any name: cut, it still names no file.
fs::path named_path(std::string_view name) {
  const auto bytes = static_cast<int>(
      std::min<std::size_t>(name.size(), std::size_t{std::numeric_limits<int>::max()}));
  const int size = ::MultiByteToWideChar(CP_UTF8, 0, name.data(), bytes, nullptr, 0);
  if (size <= 0) return {};
  std::wstring wide(static_cast<std::size_t>(size), L'\0');
  ::MultiByteToWideChar(CP_UTF8, 0, name.data(), bytes, wide.data(), size);
  return wide;
}

fs::file_status status_of(const fs::path& path, std::error_code& error) {
  if (is_short(path)) return fs::status(path, error);
  BY_HANDLE_FILE_INFORMATION found;
  if (Named(path).read(found, error)) {
    const bool is_folder = (found.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) != 0;
    return fs::file_status(is_folder ? fs::file_type::directory : fs::file_type::regular);
  }
  const bool is_missing = error == std::errc::no_such_file_or_directory;
  return fs::file_status(is_missing ? fs::file_type::not_found : fs::file_type::none);
}

std::uintmax_t size_of_file(const fs::path& path, std::error_code& error) {
  if (is_short(path)) return fs::file_size(path, error);
  BY_HANDLE_FILE_INFORMATION found;
  if (!Named(path).read(found, error)) return std::numeric_limits<std::uintmax_t>::max();
  return std::uintmax_t{found.nFileSizeHigh} << 32 | found.nFileSizeLow;
}

bool is_one_file(const fs::path& a, const fs::path& b, std::error_code& error) {
  if (is_short(a) && is_short(b)) return fs::equivalent(a, b, error);
  // Numbers of files are theirs while they are open.
  const Named first(a);
  const Named second(b);
  BY_HANDLE_FILE_INFORMATION one;
  BY_HANDLE_FILE_INFORMATION other;
  return first.read(one, error) && second.read(other, error) &&
         one.dwVolumeSerialNumber == other.dwVolumeSerialNumber &&
         one.nFileIndexHigh == other.nFileIndexHigh && one.nFileIndexLow == other.nFileIndexLow;
}

void make_folders(const fs::path& path, std::error_code& error) {
  if (is_short(path)) {
    fs::create_directories(path, error);
    return;
  }
  if (path.has_relative_path() && path.has_parent_path() && path.parent_path() != path) {
    make_folders(path.parent_path(), error);
    if (error) return;
  }
  if (!path.has_filename()) return;  // "folder/"
  const bool is_made = ::CreateDirectoryW(wide_path(path.string()).c_str(), nullptr) != 0;
  if (!is_made && ::GetLastError() != ERROR_ALREADY_EXISTS) error = last_error();
}
#else
fs::path named_path(std::string_view name) {
  return name;
}

fs::file_status status_of(const fs::path& path, std::error_code& error) {
  return fs::status(path, error);
}

std::uintmax_t size_of_file(const fs::path& path, std::error_code& error) {
  return fs::file_size(path, error);
}

bool is_one_file(const fs::path& a, const fs::path& b, std::error_code& error) {
  return fs::equivalent(a, b, error);
}

void make_folders(const fs::path& path, std::error_code& error) {
  fs::create_directories(path, error);
}
#endif

}  // namespace boxtree::cooker
