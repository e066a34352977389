// SPDX-License-Identifier: MIT
// Bytes are read by stdio, too, so that readers need not know the difference.
#include "cooker/import/source_file.h"

#include <system_error>

#include "cooker/import/whole_file.h"
#include "cooker/system/input_failure.h"
#include "cooker/system/path.h"

namespace boxtree::cooker {

SourceFile::SourceFile(const std::filesystem::path& input, const std::optional<SourceBytes>& bytes)
    : SourceFile(input) {
  if (!bytes || bytes->input != input) return;
  path_ = bytes->file_name;
  title_ = bytes->title;
  bytes_ = bytes->bytes;
}

std::string SourceFile::short_title() const {
  return bytes_ ? title_ : path_.filename().string();
}

FileHandle SourceFile::open() const {
  return bytes_ ? open_to_read(*bytes_) : open_to_read(path_);
}

Result<std::uint64_t> SourceFile::size() const {
  if (bytes_) return std::uint64_t{bytes_->size()};
  std::error_code failed;
  const std::uintmax_t size = size_of_file(path_, failed);
  if (failed) return input_failure(title_, failed.value());
  return std::uint64_t{size};
}

Result<std::string> SourceFile::read() const {
  if (!bytes_) return read_whole_file(path_, kAnyBytes);
  return std::string(reinterpret_cast<const char*>(bytes_->data()), bytes_->size());
}

std::filesystem::path tidied(const std::filesystem::path& path) {
  std::filesystem::path normal = path.lexically_normal();
  std::error_code error;
  return !exists(status_of(path, error)) || is_one_file(path, normal, error) ? normal : path;
}

}  // namespace boxtree::cooker
