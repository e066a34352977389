// SPDX-License-Identifier: MIT
// Maps files by POSIX mmap. A copy is an anonymous mapping, too, so that both are released alike.
// Compiled on Windows, this is nothing: see mapping_windows.cpp.
#ifndef _WIN32
#include <cerrno>
#include <cstdint>
#include <fcntl.h>
#include <limits>
#include <string>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

#include "format/message.h"
#include "runtime/file/mapping.h"
#include "runtime/file/read_failure.h"

namespace boxtree {
namespace {

class Descriptor {
 public:
  explicit Descriptor(const std::string& path)
      // Non-blocking, so that opening a pipe returns and the pipe can be refused.
      : value_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }
  [[nodiscard]] int value() const { return value_; }

 private:
  int value_;
};

// Size of a regular file; directories, pipes and devices cannot be mapped and are refused here.
Result<std::size_t> regular_file_size(int file, const std::string& path) {
  if (file < 0) return read_failure(path, errno);
  struct stat info {};
  if (::fstat(file, &info) != 0) return read_failure(path, errno);
  if (!S_ISREG(info.st_mode)) {
    return error_with(Errc::kFileUnreadable, path, ": not a regular file");
  }
  if (static_cast<std::uintmax_t>(info.st_size) > std::numeric_limits<std::size_t>::max()) {
    return error_with(Errc::kOutOfMemory, path, ": too large for the memory of a 32-bit program");
  }
  return static_cast<std::size_t>(info.st_size);
}

}  // namespace

void Mapping::unmap() noexcept {
  // munmap takes void*; the bytes were never writable through this object.
  if (data_ != nullptr) ::munmap(const_cast<std::byte*>(data_), size_);
}

Result<Mapping> Mapping::map(const std::string& path) {
  const Descriptor file(path);
  return map(file.value(), path);
}

Result<Mapping> Mapping::map(int descriptor, const std::string& name) {
  const Result<std::size_t> size = regular_file_size(descriptor, name);
  if (!size) return size.error();
  if (*size == 0) return Mapping();
  void* data = ::mmap(nullptr, *size, PROT_READ, MAP_PRIVATE, descriptor, 0);
  if (data == MAP_FAILED) return system_failure(Errc::kMapFailed, name, errno);
  return Mapping(static_cast<const std::byte*>(data), *size, true);
}

bool Mapping::advise([[maybe_unused]] Access access) const noexcept {
#ifdef MADV_DONTNEED  // POSIX does not have it; Linux, the BSDs and macOS do
  // Of memory that no file is behind, MADV_DONTNEED would lose the content.
  if (!is_of_file_) return false;
  const int advice = [access] {
    switch (access) {
      case Access::kNormal:
        return MADV_NORMAL;
      case Access::kRandom:
        return MADV_RANDOM;
      case Access::kSequential:
        return MADV_SEQUENTIAL;
      case Access::kWillNeed:
        return MADV_WILLNEED;
      case Access::kDontNeed:
        return MADV_DONTNEED;
    }
    return -1;  // no value of Access: the system refuses it
  }();
  return ::madvise(const_cast<std::byte*>(data_), size_, advice) == 0;
#else
  return false;
#endif
}

Result<Mapping> Mapping::copy(const std::string& path, const Memory& memory) {
  const Descriptor file(path);
  const Result<std::size_t> size = regular_file_size(file.value(), path);
  if (!size) return size.error();
  if (*size == 0) return Mapping();
  Result<WritableMapping> copied = WritableMapping::allocate(*size, memory);
  if (!copied) return error_in(path, copied.error());
  std::byte* const data = copied->bytes().data();
  for (std::size_t done = 0; done < *size;) {
    const ssize_t got = ::pread(file.value(), data + done, *size - done, static_cast<off_t>(done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return read_failure(path, errno);
    if (got == 0) return error_with(Errc::kFileUnreadable, path, ": shrank while being read");
    done += static_cast<std::size_t>(got);
  }
  return std::move(*copied).finish();
}

void* WritableMapping::pages(std::size_t size) noexcept {
  void* data = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (data == MAP_FAILED) return nullptr;
#ifdef MADV_HUGEPAGE  // Linux; where it has none, nothing is lost
  // What the 2048 entries of a processor's second-level TLB reach in pages of 4 KB.
  constexpr std::size_t kWorthHugePages = std::size_t{1} << 23;
  if (size >= kWorthHugePages) ::madvise(data, size, MADV_HUGEPAGE);
#endif
  return data;
}

}  // namespace boxtree
#endif
