// SPDX-License-Identifier: MIT
// What mappings are on every system; mapping_posix.cpp and mapping_windows.cpp have the rest.
#include "runtime/file/mapping.h"

#include <utility>

#include "format/limits.h"
#include "format/memory.h"
#include "format/message.h"

namespace boxtree {

Mapping::~Mapping() {
  if (data_ != nullptr && !is_of_file_ && memory_.release != nullptr) {
    release(&memory_, const_cast<std::byte*>(data_), size_, kLargeAlignment);
  } else {
    unmap();
  }
}

Mapping::Mapping(Mapping&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)),
      size_(std::exchange(other.size_, 0)),
      is_of_file_(other.is_of_file_),
      memory_(other.memory_) {
#ifdef _WIN32
  file_ = std::exchange(other.file_, nullptr);
#endif
}

Mapping& Mapping::operator=(Mapping&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  std::swap(is_of_file_, other.is_of_file_);
  std::swap(memory_, other.memory_);
#ifdef _WIN32
  std::swap(file_, other.file_);
#endif
  return *this;
}

Result<WritableMapping> WritableMapping::allocate(std::size_t size, const Memory& memory) {
  if (size == 0) return WritableMapping(nullptr, 0);
  void* const data = memory.allocate == nullptr
                         ? pages(size)
                         : memory.allocate(memory.context, size, kLargeAlignment);
  if (data == nullptr) {
    return error_with(Errc::kOutOfMemory, {}, "no memory for # bytes", {size});
  }
  return WritableMapping(static_cast<std::byte*>(data), size, memory);
}

}  // namespace boxtree
