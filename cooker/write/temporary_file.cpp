// SPDX-License-Identifier: MIT
// What is the same on all systems.
#include "cooker/write/temporary_file.h"

#include <utility>

#include "cooker/system/memory_file.h"
#include "cooker/system/write_failure.h"

namespace boxtree::cooker {

TemporaryFile::TemporaryFile(TemporaryFile&& other) noexcept
    : folder_(std::move(other.folder_)),
      name_(std::move(other.name_)),
      path_(std::move(other.path_)),
      is_named_(std::exchange(other.is_named_, false)),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

Result<TemporaryFile> TemporaryFile::create_in_memory(const std::string& title) {
  TemporaryFile file;
  file.descriptor_ = open_memory_file();
  if (file.descriptor_ < 0) return write_failure(title, "cannot be collected in memory");
  return file;
}

}  // namespace boxtree::cooker
