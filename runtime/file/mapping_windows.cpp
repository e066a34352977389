// SPDX-License-Identifier: MIT
// Maps files by CreateFileMapping, and copies them into memory of VirtualAlloc. Compiled elsewhere,
// this is nothing: see mapping_posix.cpp.
#ifdef _WIN32
#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <system_error>
#include <utility>

#include "runtime/file/mapping.h"

#ifndef NOMINMAX
#define NOMINMAX
#endif
#define WIN32_LEAN_AND_MEAN
#include <windows.h>

#include "runtime/file/read_failure.h"

namespace boxtree {
namespace {

class Handle {
 public:
  explicit Handle(HANDLE value) : value_(value) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (is_open()) ::CloseHandle(value_);
  }
  // Functions that open say INVALID_HANDLE_VALUE or a null pointer.
  [[nodiscard]] bool is_open() const { return value_ != INVALID_HANDLE_VALUE && value_ != nullptr; }
  [[nodiscard]] HANDLE value() const { return value_; }
  [[nodiscard]] HANDLE release() { return std::exchange(value_, nullptr); }

 private:
  HANDLE value_;
};

Error system_error(Errc code, const std::string& path, DWORD reason) {
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

// UTF-8 to what the system takes; empty if it is not UTF-8. Paths that are longer than MAX_PATH are
// made absolute, and taken as they are.
std::wstring wide_path(const std::string& path) {
  if (path.empty() || path.size() > std::size_t{std::numeric_limits<int>::max()}) return {};
  const int bytes = static_cast<int>(path.size());
  const int size =
      ::MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path.data(), bytes, nullptr, 0);
  if (size <= 0) return {};
  std::wstring wide(static_cast<std::size_t>(size), L'\0');
  ::MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path.data(), bytes, wide.data(), size);
  const bool is_taken_as_it_is = wide.starts_with(L"\\\\?\\");
  if (wide.size() < MAX_PATH || is_taken_as_it_is) return wide;
  const DWORD full_size = ::GetFullPathNameW(wide.c_str(), 0, nullptr, nullptr);
  std::wstring full(full_size, L'\0');  // with a 0 at its end
  full.resize(::GetFullPathNameW(wide.c_str(), full_size, full.data(), nullptr));
  if (full.starts_with(L"\\\\")) return L"\\\\?\\UNC\\" + full.substr(2);
  return L"\\\\?\\" + full;
}

// Opens a file to be read. `others_may_write`: at the same time.
HANDLE open_file(const std::string& path, bool others_may_write) {
  const std::wstring wide = wide_path(path);
  if (wide.empty() || wide.find(L'\0') != std::wstring::npos) {
    ::SetLastError(ERROR_INVALID_NAME);
    return INVALID_HANDLE_VALUE;
  }
  const DWORD share =
      FILE_SHARE_READ | FILE_SHARE_DELETE | (others_may_write ? DWORD{FILE_SHARE_WRITE} : DWORD{0});
  return ::CreateFileW(wide.c_str(), GENERIC_READ, share, nullptr, OPEN_EXISTING,
                       FILE_ATTRIBUTE_NORMAL, nullptr);
}

// Size of a regular file; folders, pipes and devices cannot be mapped and are refused here.
Result<std::size_t> regular_file_size(const Handle& file, const std::string& path) {
  if (!file.is_open()) return system_error(Errc::kFileUnreadable, path, ::GetLastError());
  if (::GetFileType(file.value()) != FILE_TYPE_DISK) {
    return Error{Errc::kFileUnreadable, path + ": not a regular file"};
  }
  LARGE_INTEGER size;
  if (::GetFileSizeEx(file.value(), &size) == 0) {
    return system_error(Errc::kFileUnreadable, path, ::GetLastError());
  }
  if (static_cast<std::uintmax_t>(size.QuadPart) > std::numeric_limits<std::size_t>::max()) {
    return Error{Errc::kOutOfMemory, path + ": too large for the memory of a 32-bit program"};
  }
  return static_cast<std::size_t>(size.QuadPart);
}

}  // namespace

Mapping::~Mapping() {
  if (file_ != nullptr) ::CloseHandle(file_);
  if (data_ == nullptr) return;
  void* const data = const_cast<std::byte*>(data_);
  if (is_of_file_) {
    ::UnmapViewOfFile(data);
  } else {
    ::VirtualFree(data, 0, MEM_RELEASE);
  }
}

// Nobody may write to a file that is mapped: others who open it to write are refused as long as it
// is open here.
Result<Mapping> Mapping::map(const std::string& path) {
  Handle file(open_file(path, false));
  const Result<std::size_t> size = regular_file_size(file, path);
  if (!size) return size.error();
  if (*size == 0) return Mapping();
  const Handle section(::CreateFileMappingW(file.value(), nullptr, PAGE_READONLY, 0, 0, nullptr));
  if (!section.is_open()) return system_error(Errc::kMapFailed, path, ::GetLastError());
  const void* const data = ::MapViewOfFile(section.value(), FILE_MAP_READ, 0, 0, *size);
  if (data == nullptr) return system_error(Errc::kMapFailed, path, ::GetLastError());
  Mapping mapping(static_cast<const std::byte*>(data), *size, true);
  mapping.file_ = file.release();
  return mapping;
}

bool Mapping::advise(Access access) const noexcept {
  // The system has no other advice for what is mapped already.
  if (!is_of_file_ || access != Access::kWillNeed) return false;
  WIN32_MEMORY_RANGE_ENTRY range{const_cast<std::byte*>(data_), size_};
  return ::PrefetchVirtualMemory(::GetCurrentProcess(), 1, &range, 0) != 0;
}

Result<Mapping> Mapping::copy(const std::string& path) {
  const Handle file(open_file(path, true));
  const Result<std::size_t> size = regular_file_size(file, path);
  if (!size) return size.error();
  if (*size == 0) return Mapping();
  Result<WritableMapping> copied = WritableMapping::allocate(*size);
  if (!copied) return Error{copied.code(), path + ": " + copied.error().detail};
  constexpr std::size_t kMostAtATime = std::size_t{1} << 30;
  std::byte* const data = copied->bytes().data();
  for (std::size_t done = 0; done < *size;) {
    DWORD got = 0;
    const auto wanted = static_cast<DWORD>(std::min(*size - done, kMostAtATime));
    if (::ReadFile(file.value(), data + done, wanted, &got, nullptr) == 0) {
      return system_error(Errc::kFileUnreadable, path, ::GetLastError());
    }
    if (got == 0) return Error{Errc::kFileUnreadable, path + ": shrank while being read"};
    done += got;
  }
  return std::move(*copied).finish();
}

Result<WritableMapping> WritableMapping::allocate(std::size_t size) {
  if (size == 0) return WritableMapping(nullptr, 0);
  void* const data = ::VirtualAlloc(nullptr, size, MEM_COMMIT | MEM_RESERVE, PAGE_READWRITE);
  if (data == nullptr) {
    return Error{Errc::kOutOfMemory, "no memory for " + std::to_string(size) + " bytes"};
  }
  return WritableMapping(static_cast<std::byte*>(data), size);
}

}  // namespace boxtree
#endif
