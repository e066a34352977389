// SPDX-License-Identifier: MIT
// Maps files by CreateFileMapping, and copies them into memory of VirtualAlloc. Compiled elsewhere,
// this is nothing: see mapping_posix.cpp.
#ifdef _WIN32
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <io.h>
#include <limits>
#include <string>
#include <utility>

#include "format/message.h"
#include "runtime/file/mapping.h"
#include "runtime/file/windows_path.h"

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

// Opens a file to be read. `others_may_write`: at the same time.
HANDLE open_file(const std::string& path, bool others_may_write) {
  const std::wstring wide = wide_path(path);
  if (wide.empty()) {
    ::SetLastError(ERROR_INVALID_NAME);
    return INVALID_HANDLE_VALUE;
  }
  const DWORD share =
      FILE_SHARE_READ | FILE_SHARE_DELETE | (others_may_write ? DWORD{FILE_SHARE_WRITE} : DWORD{0});
  return ::CreateFileW(wide.c_str(), GENERIC_READ, share, nullptr, OPEN_EXISTING,
                       FILE_ATTRIBUTE_NORMAL, nullptr);
}

// Size of a regular file; folders, pipes and devices cannot be mapped and are refused here.
Result<std::size_t> regular_file_size(HANDLE file, const std::string& path) {
  if (file == INVALID_HANDLE_VALUE) {
    return windows_error(Errc::kFileUnreadable, path, ::GetLastError());
  }
  if (::GetFileType(file) != FILE_TYPE_DISK) {
    return Error{Errc::kFileUnreadable, path + ": not a regular file"};
  }
  LARGE_INTEGER size;
  if (::GetFileSizeEx(file, &size) == 0) {
    return windows_error(Errc::kFileUnreadable, path, ::GetLastError());
  }
  if (static_cast<std::uintmax_t>(size.QuadPart) > std::numeric_limits<std::size_t>::max()) {
    return Error{Errc::kOutOfMemory, path + ": too large for the memory of a 32-bit program"};
  }
  return static_cast<std::size_t>(size.QuadPart);
}

}  // namespace

void Mapping::unmap() noexcept {
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
  Result<Mapping> mapping = map_handle(file.value(), path);
  if (mapping && !mapping->bytes().empty()) mapping->file_ = file.release();
  return mapping;
}

Result<Mapping> Mapping::map(int descriptor, const std::string& name) {
  return map_handle(reinterpret_cast<HANDLE>(::_get_osfhandle(descriptor)), name);
}

Result<Mapping> Mapping::map_handle(void* file, const std::string& name) {
  const Result<std::size_t> size = regular_file_size(file, name);
  if (!size) return size.error();
  if (*size == 0) return Mapping();
  const Handle section(::CreateFileMappingW(file, nullptr, PAGE_READONLY, 0, 0, nullptr));
  if (!section.is_open()) return windows_error(Errc::kMapFailed, name, ::GetLastError());
  const void* const data = ::MapViewOfFile(section.value(), FILE_MAP_READ, 0, 0, *size);
  if (data == nullptr) return windows_error(Errc::kMapFailed, name, ::GetLastError());
  return Mapping(static_cast<const std::byte*>(data), *size, true);
}

bool Mapping::advise(Access access) const noexcept {
  // The system has no other advice for what is mapped already.
  if (!is_of_file_ || access != Access::kWillNeed) return false;
  WIN32_MEMORY_RANGE_ENTRY range{const_cast<std::byte*>(data_), size_};
  return ::PrefetchVirtualMemory(::GetCurrentProcess(), 1, &range, 0) != 0;
}

Result<Mapping> Mapping::copy(const std::string& path, const Memory& memory) {
  const Handle file(open_file(path, true));
  const Result<std::size_t> size = regular_file_size(file.value(), path);
  if (!size) return size.error();
  if (*size == 0) return Mapping();
  Result<WritableMapping> copied = WritableMapping::allocate(*size, memory);
  if (!copied) return error_in(path, copied.error());
  constexpr std::size_t kMostAtATime = std::size_t{1} << 30;
  std::byte* const data = copied->bytes().data();
  for (std::size_t done = 0; done < *size;) {
    DWORD got = 0;
    const auto wanted = static_cast<DWORD>(std::min(*size - done, kMostAtATime));
    if (::ReadFile(file.value(), data + done, wanted, &got, nullptr) == 0) {
      return windows_error(Errc::kFileUnreadable, path, ::GetLastError());
    }
    if (got == 0) return Error{Errc::kFileUnreadable, path + ": shrank while being read"};
    done += got;
  }
  return std::move(*copied).finish();
}

void* WritableMapping::pages(std::size_t size) noexcept {
  return ::VirtualAlloc(nullptr, size, MEM_COMMIT | MEM_RESERVE, PAGE_READWRITE);
}

}  // namespace boxtree
#endif
