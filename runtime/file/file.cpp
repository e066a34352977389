// SPDX-License-Identifier: MIT
// Opening: everything that can be known of a file without reading what it holds.
#include <string>
#include <utility>

#include <boxtree/file.h>

#include "runtime/file/checksum.h"

namespace boxtree {
Result<File> File::open(const std::filesystem::path& path, const OpenOptions& options) {
  Result<Mapping> mapping = options.copy ? Mapping::copy(path) : Mapping::map(path);
  if (!mapping) return mapping.error();
  Result<File> checked = open(std::move(*mapping), options);
  if (!checked) return Error{checked.code(), path.string() + ": " + checked.error().detail};
  return checked;
}

Result<File> File::open(Mapping owned, const OpenOptions& options) {
  File file;
  file.bytes_ = owned.bytes();
  file.mapping_ = std::move(owned);
  return check(std::move(file), options);
}

Result<File> File::open(Bytes memory, const OpenOptions& options) {
  File file;
  file.bytes_ = memory;
  return check(std::move(file), options);
}

Result<File> File::check(File file, const OpenOptions& options) {
  Result<Container> container = check_container(file.bytes_, checksum);
  if (!container) return container.error();
  file.container_ = std::move(*container);

  if (file.container_.find(SectionKind::kTrees, kNoOwner) == nullptr) {
    return Error{Errc::kSectionMissing, "the file has no section \"trees\""};
  }
  const std::size_t table_bytes = file.section(SectionKind::kTrees).size();
  if (table_bytes % sizeof(TreeRecord) != 0 || table_bytes / sizeof(TreeRecord) > kMaxTrees) {
    return Error{Errc::kSectionSize, "section \"trees\" has " + std::to_string(table_bytes) +
                                         " bytes, expected a multiple of " +
                                         std::to_string(sizeof(TreeRecord)) + " up to " +
                                         std::to_string(kMaxTrees) + " records"};
  }
  file.tree_count_ = static_cast<std::uint32_t>(table_bytes / sizeof(TreeRecord));
  if (options.verify_checksums) {
    if (Status status = boxtree::verify_checksums(file); !status) return status.error();
  }
  return file;
}

TreeRecord File::tree_record(std::uint32_t index) const noexcept {
  return load<TreeRecord>(section(SectionKind::kTrees).data(), index);
}

std::string_view File::tree_name(std::uint32_t index) const noexcept {
  const TreeRecord record = tree_record(index);
  const Bytes names = section(SectionKind::kNames);
  if (!in_range(record.name_offset, record.name_bytes, names.size())) return {};
  return {reinterpret_cast<const char*>(names.data()) + record.name_offset, record.name_bytes};
}

Result<std::uint32_t> File::find_tree(std::string_view name) const {
  for (std::uint32_t i = 0; i < tree_count_; ++i) {
    if (tree_name(i) == name) return i;
  }
  return Error{Errc::kTreeIndex, "no tree is named \"" + std::string(name) + "\""};
}

Bytes File::section(SectionKind kind, std::uint32_t owner) const noexcept {
  const SectionEntry* entry = container_.find(kind, owner);
  return entry == nullptr ? Bytes{} : bytes_.subspan(entry->offset, entry->size);
}

Status verify_checksums(const File& file) {
  const std::vector<SectionEntry>& sections = file.container().sections;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const SectionEntry& entry = sections[i];
    if (checksum(file.bytes().subspan(entry.offset, entry.size)) != entry.checksum) {
      return Error{Errc::kChecksumMismatch,
                   "section " + std::to_string(i) + " (" +
                       std::string(section_name(static_cast<SectionKind>(entry.kind))) +
                       "): checksum differs"};
    }
  }
  return {};
}

}  // namespace boxtree
