// SPDX-License-Identifier: MIT
// What mappings are on every system; mapping_posix.cpp and mapping_windows.cpp have the rest.
#include "runtime/file/mapping.h"

#include <utility>

namespace boxtree {

Mapping::Mapping(Mapping&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)),
      size_(std::exchange(other.size_, 0)),
      is_of_file_(other.is_of_file_) {
#ifdef _WIN32
  file_ = std::exchange(other.file_, nullptr);
#endif
}

Mapping& Mapping::operator=(Mapping&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  std::swap(is_of_file_, other.is_of_file_);
#ifdef _WIN32
  std::swap(file_, other.file_);
#endif
  return *this;
}

}  // namespace boxtree
