// SPDX-License-Identifier: MIT
// The file as applications see it.
#include <string>
#include <utility>

#include <boxtree/file.h>

#include "runtime/file/open_file.h"

namespace boxtree {

Result<File> File::open(const std::string& path, const OpenOptions& options) {
  Result<Mapping> mapping = options.copy ? Mapping::copy(path) : Mapping::map(path);
  if (!mapping) return mapping.error();
  Result<File> checked = OpenFile::open(std::move(*mapping), options);
  if (!checked) return Error{checked.code(), path + ": " + checked.error().detail};
  return checked;
}

Result<File> File::open(Bytes memory, const OpenOptions& options) {
  return OpenFile::open(memory, options);
}

File::File(std::unique_ptr<const OpenFile> open) noexcept : open_(std::move(open)) {}
File::File(File&&) noexcept = default;
File& File::operator=(File&&) noexcept = default;
File::~File() = default;

Bytes File::bytes() const noexcept {
  return open_->bytes();
}
bool File::advise(Access access) const noexcept {
  return open_->advise(access);
}
std::uint32_t File::tree_count() const noexcept {
  return open_->tree_count();
}
bool File::has_scene() const noexcept {
  return !open_->section(SectionKind::kScene).empty();
}

std::string_view File::tree_name(std::uint32_t index) const noexcept {
  return index < tree_count() ? open_->tree_name(index) : std::string_view();
}

Result<std::uint32_t> File::find_tree(std::string_view name) const {
  for (std::uint32_t i = 0; i < tree_count(); ++i) {
    if (tree_name(i) == name) return i;
  }
  return Error{Errc::kTreeIndex, "no tree is named \"" + std::string(name) + "\""};
}

Status verify_checksums(const File& file) {
  return OpenFile::of(file).verify_checksums();
}

}  // namespace boxtree
