// SPDX-License-Identifier: MIT
// Opens files: checks everything that can be checked without reading nodes and geometry.
#include "runtime/file/open_file.h"

#include <memory>
#include <string>
#include <utility>

#include "format/message.h"
#include "format/tree_record.h"
#include "runtime/file/checksum.h"

namespace boxtree {

Result<File> OpenFile::open(Mapping owned, const OpenOptions& options) {
  std::unique_ptr<OpenFile> file(new OpenFile());
  file->bytes_ = owned.bytes();
  file->mapping_ = std::move(owned);
  return check(std::move(file), options);
}

Result<File> OpenFile::open(Bytes memory, const OpenOptions& options) {
  std::unique_ptr<OpenFile> file(new OpenFile());
  file->bytes_ = memory;
  return check(std::move(file), options);
}

Result<File> OpenFile::check(std::unique_ptr<OpenFile> file, const OpenOptions& options) {
  Result<Container> container = check_container(file->bytes_, checksum);
  if (!container) return container.error();
  file->container_ = std::move(*container);

  if (file->container_.find(SectionKind::kTrees, kNoOwner) == nullptr) {
    return error_with(Errc::kSectionMissing, {}, "the file has no section \"trees\"");
  }
  const std::size_t table_bytes = file->section(SectionKind::kTrees).size();
  if (table_bytes % sizeof(TreeRecord) != 0 || table_bytes / sizeof(TreeRecord) > kMaxTrees) {
    return error_with(Errc::kSectionSize, {},
                      "section \"trees\" has # bytes, expected a multiple of # up to # records",
                      {table_bytes, sizeof(TreeRecord), kMaxTrees});
  }
  file->tree_count_ = static_cast<std::uint32_t>(table_bytes / sizeof(TreeRecord));
  if (options.verify_checksums) {
    if (Status status = file->verify_checksums(); !status) return status.error();
  }
  return File(std::move(file));
}

TreeRecord OpenFile::tree_record(std::uint32_t index) const noexcept {
  return load<TreeRecord>(section(SectionKind::kTrees).data(), index);
}

std::string_view OpenFile::tree_name(std::uint32_t index) const noexcept {
  const TreeRecord record = tree_record(index);
  const Bytes names = section(SectionKind::kNames);
  if (!in_range(record.name_offset, record.name_bytes, names.size())) return {};
  return {reinterpret_cast<const char*>(names.data()) + record.name_offset, record.name_bytes};
}

Bytes OpenFile::section(SectionKind kind, std::uint32_t owner) const noexcept {
  const SectionEntry* entry = container_.find(kind, owner);
  return entry == nullptr ? Bytes{} : bytes_.subspan(entry->offset, entry->size);
}

Status OpenFile::verify_checksums() const {
  for (std::size_t i = 0; i < container_.sections.size(); ++i) {
    const SectionEntry& entry = container_.sections[i];
    if (checksum(bytes_.subspan(entry.offset, entry.size)) != entry.checksum) {
      return error_with(Errc::kChecksumMismatch, "section ",
                        "# (" + std::string(section_name(entry.kind)) + "): checksum differs", {i});
    }
  }
  return {};
}

}  // namespace boxtree
