// SPDX-License-Identifier: MIT
// Opens files: checks everything that can be checked without reading nodes, geometry and members.
#include "runtime/file/open_file.h"

#include <memory>
#include <string>
#include <utility>

#include "format/message.h"
#include "format/pack.h"
#include "format/tree_record.h"
#include "runtime/file/checksum.h"

namespace boxtree {

OpenFile::Owner OpenFile::make(const Memory& memory) {
  void* const place = allocate(&memory, sizeof(OpenFile), alignof(OpenFile));
  return Owner(::new (place) OpenFile(memory));
}

Result<File> OpenFile::open(Mapping owned, const OpenOptions& options) {
  Owner file = make(options.memory);
  file->bytes_ = owned.bytes();
  file->mapping_ = std::move(owned);
  return check(std::move(file), options, kFeaturePack);
}

Result<File> OpenFile::open(Bytes memory, const OpenOptions& options) {
  Owner file = make(options.memory);
  file->bytes_ = memory;
  return check(std::move(file), options, kFeaturePack);
}

Result<File> OpenFile::check(Owner file, const OpenOptions& options, std::uint32_t known_features) {
  Result<Container> container =
      check_container(file->bytes_, checksum, known_features, &file->memory_);
  if (!container) return container.error();
  file->container_ = std::move(*container);

  const bool is_pack = file->is_pack();
  const SectionKind kind = is_pack ? SectionKind::kPack : SectionKind::kTrees;
  const SectionEntry* const table = file->container_.find(kind, kNoOwner);
  if (table == nullptr) {
    return error_with(Errc::kSectionMissing, section_name(kind), ": the file has no such section");
  }
  const std::size_t record_bytes = is_pack ? sizeof(PackRow) : sizeof(TreeRecord);
  const std::uint32_t most = is_pack ? kMaxPackedTrees : kMaxTrees;
  if (table->size % record_bytes != 0 || table->size / record_bytes > most) {
    return error_with(Errc::kSectionSize, section_name(kind),
                      ": the section has # bytes, expected a multiple of # up to # records",
                      {table->size, record_bytes, most});
  }
  file->tree_count_ = static_cast<std::uint32_t>(table->size / record_bytes);
  if (options.verify_checksums) {
    std::size_t first = 0;
    if (Status status = file->verify_checksums(first); !status) return status.error();
  }
  return File(std::move(file));
}

TreeRecord OpenFile::tree_record(std::uint32_t index) const noexcept {
  return load<TreeRecord>(section(SectionKind::kTrees).data(), index);
}

bool OpenFile::is_pack() const noexcept {
  return (container_.header.incompatible_features & kFeaturePack) != 0;
}

PackRow OpenFile::pack_row(std::uint32_t index) const noexcept {
  return load<PackRow>(section(SectionKind::kPack).data(), index);
}

Result<File> OpenFile::open_member(std::uint32_t index) const {
  const PackRow row = pack_row(index);
  const Bytes members = section(SectionKind::kMembers);
  Error error{Errc::kRecordInvalid, "its member ends behind section members"};
  if (in_range(row.offset, row.bytes, members.size())) {
    Owner opened = make(memory_);
    opened->bytes_ = members.subspan(row.offset, row.bytes);
    Result<File> file = check(std::move(opened), {}, 0);  // no pack in a pack
    if (file && row.tree < file->tree_count()) return file;
    error = file ? index_error(Errc::kRecordInvalid, "tree", row.tree, file->tree_count())
                 : file.error();
  }
  return error_of("tree", index, error);
}

std::string_view OpenFile::tree_name(std::uint32_t index) const noexcept {
  std::uint32_t offset = 0;
  std::uint32_t size = 0;
  if (is_pack()) {
    const PackRow row = pack_row(index);
    offset = row.name_offset;
    size = row.name_bytes;
  } else {
    const TreeRecord record = tree_record(index);
    offset = record.name_offset;
    size = record.name_bytes;
  }
  const Bytes names = section(SectionKind::kNames);
  if (!in_range(offset, size, names.size())) return {};
  return {reinterpret_cast<const char*>(names.data()) + offset, size};
}

Bytes OpenFile::section(SectionKind kind, std::uint32_t owner) const noexcept {
  const SectionEntry* entry = container_.find(kind, owner);
  return entry == nullptr ? Bytes{} : bytes_.subspan(entry->offset, entry->size);
}

Status OpenFile::verify_checksums(std::size_t& section) const {
  for (; section < container_.sections.size(); ++section) {
    const SectionEntry& entry = container_.sections[section];
    if (checksum(bytes_.subspan(entry.offset, entry.size)) != entry.checksum) {
      return error_at(
          error_with(Errc::kChecksumMismatch, {}, "section # (", {section}).detail,
          error_with(Errc::kChecksumMismatch, section_name(entry.kind), "): checksum differs"));
    }
  }
  return {};
}

}  // namespace boxtree
