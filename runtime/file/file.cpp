// SPDX-License-Identifier: MIT
// The file as applications see it.
#include <algorithm>
#include <string>
#include <utility>

#include <boxtree/file.h>

#include "format/message.h"
#include "format/pack.h"
#include "runtime/file/open_file.h"

namespace boxtree {

Result<File> File::open(const std::string& path, const OpenOptions& options) {
  Result<Mapping> mapping = options.copy ? Mapping::copy(path, options.memory) : Mapping::map(path);
  if (!mapping) return mapping.error();
  Result<File> checked = OpenFile::open(std::move(*mapping), options);
  if (!checked) return error_in(path, checked.error());
  return checked;
}

Result<File> File::open(Bytes memory, const OpenOptions& options) {
  return OpenFile::open(memory, options);
}

File::File(std::unique_ptr<const OpenFile, Ends> open) noexcept : open_(std::move(open)) {}
void File::Ends::operator()(const OpenFile* open) const noexcept {
  destroy(open);
}
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
bool File::is_pack() const noexcept {
  return open_->is_pack();
}
Result<Member> File::member(std::uint32_t index) const {
  if (index >= tree_count()) return index_error(Errc::kTreeIndex, "tree", index, tree_count());
  Result<File> file =
      is_pack() ? open_->open_member(index) : open(bytes(), {.memory = open_->memory()});
  if (!file) return file.error();
  return Member{std::move(*file), is_pack() ? open_->pack_row(index).tree : index};
}
bool File::has_scene() const noexcept {
  return !open_->section(SectionKind::kScene).empty();
}

std::string_view File::tree_name(std::uint32_t index) const noexcept {
  return index < tree_count() ? open_->tree_name(index) : std::string_view();
}

Result<std::uint32_t> File::find_tree(std::string_view name) const {
  std::uint32_t i = 0, end = tree_count();
  if (is_pack()) {
    // The first that is not before the name, and no other. Bytes are unsigned in char_traits<char>,
    // too.
    for (std::uint32_t count = tree_count(); count > 0;) {
      const std::uint32_t half = count / 2;
      const bool is_before = tree_name(i + half) < name;
      if (is_before) i += half + 1;
      count = is_before ? count - half - 1 : half;
    }
    end = std::min(end, i + 1);
  }
  for (; i < end; ++i) {
    if (tree_name(i) == name) return i;
  }
  return Error{Errc::kTreeIndex, "no tree is named \"" + std::string(name) + "\""};
}

Status verify_checksums(const File& file) {
  std::size_t first = 0;
  return OpenFile::of(file).verify_checksums(first);
}

}  // namespace boxtree
