// SPDX-License-Identifier: MIT
// Container checks. Every offset and size of a file is checked here before it is used.
#include "format/container.h"

#include <algorithm>
#include <string>
#include <string_view>

#include "format/bits.h"
#include "format/message.h"

namespace boxtree {
namespace {

constexpr std::uint32_t kSizeBits = 40;
constexpr std::uint32_t kRequiredBit = 40;
constexpr std::uint32_t kKindBegin = 41;
constexpr std::uint32_t kOwnerBegin = 48;

// The number of an owner in a row.
std::uint64_t number_of(std::uint32_t owner) {
  return owner == kNoOwner ? 0 : owner + std::uint64_t{1};
}

std::uint64_t key_of(SectionKind kind, std::uint32_t owner) {
  return number_of(owner) << (kOwnerBegin - kKindBegin) | static_cast<std::uint64_t>(kind);
}

// An error about one section. `text` begins with "): ".
Error section_error(Errc code, std::size_t index, const SectionEntry& entry, std::string_view text,
                    std::initializer_list<std::uint64_t> numbers = {}) {
  return error_at(error_with(code, {}, "section # (", {index}).detail,
                  error_with(code, section_name(entry.kind), text, numbers));
}

// As far as the file goes: what is too short for a header may be no .bxt file at all.
Status check_magic(Bytes file) {
  const Bytes magic = std::as_bytes(std::span(kMagic));
  const Bytes start = file.first(std::min(file.size(), magic.size()));
  if (std::equal(start.begin(), start.end(), magic.begin())) return {};
  return error_with(Errc::kBadMagic, {},
                    "the first # bytes are not a .bxt magic; a mesh has to be cooked first",
                    {start.size()});
}

Status check_header(const FileHeader& header, std::uint64_t file_size,
                    std::uint32_t known_features) {
  if (header.version_major != kVersionMajor) {
    return error_with(Errc::kVersionUnsupported, {},
                      "file has format version #.#, this reader knows #.#",
                      {header.version_major, header.version_minor, kVersionMajor, kVersionMinor});
  }
  if ((header.incompatible_features & ~known_features) != 0) {
    return error_with(Errc::kFeatureUnsupported, {},
                      "incompatible feature bits # (1: use open_blob())",
                      {header.incompatible_features});
  }
  if (header.section_count > kMaxSections) {
    return error_with(Errc::kTooManySections, {}, "# sections, limit #",
                      {header.section_count, kMaxSections});
  }
  if (table_end(header.section_count) > file_size) {
    return error_with(Errc::kTruncated, {}, "# sections do not fit into # bytes",
                      {header.section_count, file_size});
  }
  return {};
}

}  // namespace

std::string_view section_name(SectionKind kind) noexcept {
  switch (kind) {
    case SectionKind::kTrees:
      return "trees";
    case SectionKind::kNodes:
      return "nodes";
    case SectionKind::kVertices:
      return "vertices";
    case SectionKind::kCorners:
      return "corners";
    case SectionKind::kFaceIds:
      return "face_ids";
    case SectionKind::kNames:
      return "names";
    case SectionKind::kCookRecord:
      return "cook_record";
    case SectionKind::kBlob:
      return "blob";
    case SectionKind::kScene:
      return "scene";
    case SectionKind::kSceneNodes:
      return "scene_nodes";
    case SectionKind::kInstances:
      return "instances";
    case SectionKind::kPoses:
      return "poses";
    case SectionKind::kLayers:
      return "layers";
    case SectionKind::kMaterials:
      return "materials";
    case SectionKind::kMaterialRuns:
      return "material_runs";
    case SectionKind::kFaceMaterials:
      return "face_materials";
    case SectionKind::kLeftOut:
      return "left_out";
    case SectionKind::kDuplicates:
      return "duplicates";
    case SectionKind::kActiveEdges:
      return "active_edges";
    case SectionKind::kInstanceEdges:
      return "instance_edges";
    case SectionKind::kUserDataRuns:
      return "user_data_runs";
    case SectionKind::kFaceUserData:
      return "face_user_data";
    case SectionKind::kPack:
      return "pack";
    case SectionKind::kMembers:
      return "members";
  }
  return "unknown";
}

SectionEntry SectionEntry::of(const SectionRow& row, std::uint64_t previous_end) noexcept {
  SectionEntry entry;
  entry.size = row.word & low_bits(kSizeBits);
  entry.is_required = (row.word >> kRequiredBit & 1) != 0;
  entry.kind =
      static_cast<SectionKind>(row.word >> kKindBegin & low_bits(kOwnerBegin - kKindBegin));
  const std::uint64_t number = row.word >> kOwnerBegin;
  entry.owner = number == 0 ? kNoOwner : static_cast<std::uint32_t>(number - 1);
  entry.offset = section_begin(previous_end, entry.size);
  entry.checksum = row.checksum;
  return entry;
}

SectionRow SectionEntry::row() const noexcept {
  return {size | std::uint64_t{is_required} << kRequiredBit | key() << kKindBegin, checksum};
}

std::uint64_t SectionEntry::key() const noexcept {
  return key_of(kind, owner);
}

const SectionEntry* Container::find(SectionKind kind, std::uint32_t owner) const noexcept {
  const std::uint64_t key = key_of(kind, owner);
  const auto place =
      std::lower_bound(sections.begin(), sections.end(), key,
                       [](const SectionEntry& entry, std::uint64_t k) { return entry.key() < k; });
  return place == sections.end() || place->key() != key ? nullptr : &*place;
}

FileHeader make_header(std::span<const SectionRow> table, std::uint32_t features,
                       ChecksumFunction checksum) noexcept {
  FileHeader header{};
  header.magic = kMagic;
  header.version_major = kVersionMajor;
  header.version_minor = kVersionMinor;
  header.section_count = static_cast<std::uint32_t>(table.size());
  header.incompatible_features = features;
  const Bytes before = std::as_bytes(std::span(&header, 1)).first(offsetof(FileHeader, checksum));
  header.checksum = checksum(before, std::as_bytes(table));
  return header;
}

Result<Container> check_container(Bytes file, ChecksumFunction checksum,
                                  std::uint32_t known_features, const Memory* memory) {
  if (Status status = check_magic(file); !status) return status.error();
  if (file.size() < sizeof(FileHeader)) {
    return error_with(Errc::kTruncated, {}, "the file has # bytes, a header alone has #",
                      {file.size(), sizeof(FileHeader)});
  }
  Container container;
  container.header = load<FileHeader>(file.data());
  const FileHeader& header = container.header;
  if (Status status = check_header(header, file.size(), known_features); !status)
    return status.error();

  std::uint64_t end = table_end(header.section_count);
  const Bytes table = file.subspan(sizeof(FileHeader), end - sizeof(FileHeader));
  if (checksum(file.first(offsetof(FileHeader, checksum)), table) != header.checksum) {
    return Error{Errc::kHeaderCorrupt, "checksum of header and section table differs"};
  }
  // kMaxSections sizes of 40 bits do not overflow.
  container.sections = Array<SectionEntry>(header.section_count, memory);
  for (std::size_t i = 0; i < header.section_count; ++i) {
    const SectionEntry entry = SectionEntry::of(load<SectionRow>(table.data(), i), end);
    if (entry.is_required && section_name(entry.kind) == "unknown") {
      return section_error(Errc::kSectionUnknown, i, entry, "): kind # is required",
                           {static_cast<std::uint64_t>(entry.kind)});
    }
    if (i > 0 && entry.key() <= container.sections[i - 1].key()) {
      return section_error(Errc::kSectionOrder, i, entry, "): it is not after the one before");
    }
    container.sections[i] = entry;
    end = entry.end();
  }
  if (const std::uint64_t whole = file_end(end); whole != file.size()) {
    const bool is_longer = whole < file.size();
    return error_with(Errc::kTruncated, {},
                      is_longer ? "the file has # bytes after its end" : "the file lacks # bytes",
                      {is_longer ? file.size() - whole : whole - file.size()});
  }
  return container;
}

Status check_padding(Bytes file, const Container& container) {
  std::uint64_t begin = table_end(container.sections.size());
  const auto check_gap = [&](std::uint64_t end) -> Status {
    const Bytes gap = file.subspan(begin, end - begin);
    const auto stain =
        std::find_if(gap.begin(), gap.end(), [](std::byte b) { return b != std::byte{0}; });
    if (stain == gap.end()) return {};
    return error_with(Errc::kPaddingNotZero, {}, "byte # is padding and not zero",
                      {begin + static_cast<std::uint64_t>(stain - gap.begin())});
  };
  for (const SectionEntry& entry : container.sections) {
    if (Status status = check_gap(entry.offset); !status) return status;
    begin = entry.end();
  }
  return check_gap(file.size());
}

}  // namespace boxtree
