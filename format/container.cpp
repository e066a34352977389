// SPDX-License-Identifier: MIT
// Container checks. Every offset and size of a file is checked here before it is used.
#include "format/container.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <string_view>

#include "format/message.h"

namespace boxtree {
namespace {

// An error about one section.
Error section_error(Errc code, std::size_t index, const SectionEntry& entry, std::string_view text,
                    std::initializer_list<std::uint64_t> numbers = {}) {
  std::string place = "section " + std::to_string(index) + " (";
  place += section_name(static_cast<SectionKind>(entry.kind));
  place += "): ";
  return error_with(code, place, text, numbers);
}

bool is_known(std::uint32_t kind) {
  return section_name(static_cast<SectionKind>(kind)) != "unknown";
}

// As far as the file goes: what is too short for a header may be no .bxt file at all.
Status check_magic(Bytes file) {
  const Bytes magic = std::as_bytes(std::span(kMagic));
  const Bytes start = file.first(std::min(file.size(), magic.size()));
  if (std::equal(start.begin(), start.end(), magic.begin())) return {};
  return error_with(Errc::kBadMagic, {}, "the first # bytes are not a .bxt magic", {start.size()});
}

Status check_header(const FileHeader& header, std::uint64_t file_size,
                    std::uint64_t known_features) {
  if (header.version_major != kVersionMajor) {
    return error_with(Errc::kVersionUnsupported, {},
                      "file has format version #.#, this reader knows #.#",
                      {header.version_major, header.version_minor, kVersionMajor, kVersionMinor});
  }
  if ((header.incompatible_features & ~known_features) != 0) {
    return error_with(Errc::kFeatureUnsupported, {}, "incompatible feature bits #",
                      {header.incompatible_features});
  }
  if (header.header_bytes != sizeof(FileHeader) || header.reserved0 != 0 || header.reserved1 != 0) {
    return Error{Errc::kHeaderCorrupt, "header size or reserved fields are not as specified"};
  }
  if (header.file_bytes != file_size) {
    return error_with(Errc::kTruncated, {}, "header states # bytes, the file has #",
                      {header.file_bytes, file_size});
  }
  if (header.section_count > kMaxSections) {
    return error_with(Errc::kTooManySections, {}, "# sections, limit #",
                      {header.section_count, kMaxSections});
  }
  return {};
}

// `free_from`: the end of what precedes the section; set to the end of the section.
Status check_section(std::size_t index, const SectionEntry& entry, std::uint64_t file_size,
                     std::uint64_t& free_from) {
  if (!is_known(entry.kind) && (entry.flags & kSectionRequired) != 0) {
    return section_error(Errc::kSectionUnknown, index, entry, "kind # is required", {entry.kind});
  }
  if ((entry.flags & ~kSectionRequired) != 0 || entry.reserved != 0) {
    return section_error(Errc::kHeaderCorrupt, index, entry, "reserved bits are set");
  }
  if (entry.offset % kSectionAlignment != 0) {
    return section_error(Errc::kSectionMisaligned, index, entry, "offset # is not a multiple of 64",
                         {entry.offset});
  }
  if (entry.offset < free_from || entry.offset - free_from > kMaxSectionGap) {
    return section_error(Errc::kSectionOverlap, index, entry,
                         "offset #, expected at least # and at most # above",
                         {entry.offset, free_from, kMaxSectionGap});
  }
  if (!in_range(entry.offset, entry.size, file_size)) {
    return section_error(Errc::kSectionOutOfRange, index, entry,
                         "offset # + # ends past file size #",
                         {entry.offset, entry.size, file_size});
  }
  free_from = entry.offset + entry.size;
  return {};
}

std::uint64_t key_of(std::uint32_t kind, std::uint32_t owner) {
  return std::uint64_t{kind} << 32 | owner;
}
std::uint64_t key_of(const SectionEntry& entry) {
  return key_of(entry.kind, entry.owner);
}

// Sorts the sections for find(), which needs each kind and owner to occur once.
Status index_sections(Container& container) {
  const std::vector<SectionEntry>& sections = container.sections;
  std::vector<std::uint32_t>& order = container.by_kind_and_owner;
  order.resize(sections.size());
  std::iota(order.begin(), order.end(), 0u);
  // A heap sort, because it takes less code than std::sort. Equal keys are refused below.
  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    return key_of(sections[a]) < key_of(sections[b]);
  };
  std::make_heap(order.begin(), order.end(), before);
  std::sort_heap(order.begin(), order.end(), before);
  const auto twice = std::adjacent_find(
      order.begin(), order.end(),
      [&](std::uint32_t a, std::uint32_t b) { return key_of(sections[a]) == key_of(sections[b]); });
  if (twice == order.end()) return {};
  return section_error(Errc::kSectionDuplicate, *twice, sections[*twice], "owner # has it twice",
                       {sections[*twice].owner});
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
    case SectionKind::kCertificate:
      return "certificate";
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
  }
  return "unknown";
}

const SectionEntry* Container::find(SectionKind kind, std::uint32_t owner) const noexcept {
  const std::uint64_t key = key_of(static_cast<std::uint32_t>(kind), owner);
  const auto place = std::lower_bound(
      by_kind_and_owner.begin(), by_kind_and_owner.end(), key,
      [this](std::uint32_t i, std::uint64_t k) { return key_of(sections[i]) < k; });
  if (place == by_kind_and_owner.end() || key_of(sections[*place]) != key) return nullptr;
  return &sections[*place];
}

FileHeader make_header(std::span<const SectionEntry> sections, std::uint64_t features,
                       ChecksumFunction checksum) noexcept {
  const std::uint64_t end =
      sections.empty() ? sizeof(FileHeader) : sections.back().offset + sections.back().size;
  FileHeader header{};
  header.magic = kMagic;
  header.version_major = kVersionMajor;
  header.version_minor = kVersionMinor;
  header.header_bytes = sizeof(FileHeader);
  header.file_bytes = align_up(end, kSectionAlignment);
  header.incompatible_features = features;
  header.section_count = static_cast<std::uint32_t>(sections.size());
  const Bytes before = std::as_bytes(std::span(&header, 1)).first(offsetof(FileHeader, checksum));
  header.checksum = checksum(before, std::as_bytes(sections));
  return header;
}

Result<Container> check_container(Bytes file, ChecksumFunction checksum,
                                  std::uint64_t known_features) {
  if (Status status = check_magic(file); !status) return status.error();
  if (file.size() < sizeof(FileHeader)) {
    return error_with(Errc::kTruncated, {}, "the file has # bytes, a header alone has #",
                      {file.size(), sizeof(FileHeader)});
  }
  Container container{load<FileHeader>(file.data()), {}, {}};
  const FileHeader& header = container.header;
  if (Status status = check_header(header, file.size(), known_features); !status)
    return status.error();

  const std::uint64_t table_bytes = std::uint64_t{header.section_count} * sizeof(SectionEntry);
  if (!in_range(sizeof(FileHeader), table_bytes, file.size())) {
    return Error{Errc::kTruncated, "the section table ends past the file"};
  }
  const Bytes table = file.subspan(sizeof(FileHeader), table_bytes);
  if (checksum(file.first(offsetof(FileHeader, checksum)), table) != header.checksum) {
    return Error{Errc::kHeaderCorrupt, "checksum of header and section table differs"};
  }

  container.sections.reserve(header.section_count);
  std::uint64_t free_from = sizeof(FileHeader) + table_bytes;
  for (std::size_t i = 0; i < header.section_count; ++i) {
    const auto entry = load<SectionEntry>(table.data(), i);
    if (Status status = check_section(i, entry, file.size(), free_from); !status) {
      return status.error();
    }
    container.sections.push_back(entry);
  }
  if (file.size() - free_from >= kSectionAlignment) {
    return Error{Errc::kSectionOutOfRange, "bytes after the last section belong to none"};
  }
  if (Status status = index_sections(container); !status) return status.error();
  return container;
}

Status check_padding(Bytes file, const Container& container) {
  std::uint64_t begin = sizeof(FileHeader) + container.sections.size() * sizeof(SectionEntry);
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
    begin = entry.offset + entry.size;
  }
  return check_gap(file.size());
}

}  // namespace boxtree
