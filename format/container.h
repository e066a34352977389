// SPDX-License-Identifier: MIT
// The container of a .bxt file: header, section table, and the checks of both. Layouts are the
// specification; docs/FORMAT.md explains them in words. Sections follow one another, so that their
// sizes say where they lie: no table can make them overlap or leave gaps.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>

#include <boxtree/error.h>

#include "format/bytes.h"
#include "format/limits.h"
#include "format/memory.h"

namespace boxtree {

/// A byte above 127, letters, CR LF, end-of-text for DOS, LF: 7-bit, text-mode and line-ending
/// damage all change it (the PNG idea).
inline constexpr std::array<std::uint8_t, 8> kMagic = {0x89, 'B', 'X', 'T', '\r', '\n', 0x1a, '\n'};
inline constexpr std::uint16_t kVersionMajor = 1;
inline constexpr std::uint16_t kVersionMinor = 0;

/// First bytes of the file, followed by the section table.
struct FileHeader {
  std::array<std::uint8_t, 8> magic;
  std::uint16_t version_major;  // a reader refuses any other
  std::uint16_t version_minor;  // a reader accepts any
  std::uint32_t section_count;
  std::uint32_t incompatible_features;  // a reader refuses bits it does not know
  std::uint32_t compatible_features;    // a reader ignores bits it does not know
  std::uint64_t checksum;  // XXH3-64 of the 24 bytes before it and the whole section table
};
static_assert(sizeof(FileHeader) == 32 && std::is_trivially_copyable_v<FileHeader>);
static_assert(offsetof(FileHeader, section_count) == 12 && offsetof(FileHeader, checksum) == 24);

/// What a section holds. Numbers are pinned.
enum class SectionKind : std::uint32_t {
  kTrees = 1,       // TreeRecord[], one per tree; owner kNoOwner
  kNodes = 2,       // the codec's nodes
  kVertices = 3,    // geometry arrays: positions; exact, grid: the bytes of clusters
  kCorners = 4,     // geometry arrays: vertex numbers of each face
  kFaceIds = 5,     // source face number of each face (format/face_ids.h)
  kNames = 7,       // UTF-8 names of all trees, joined; owner kNoOwner
  kCookRecord = 8,  // UTF-8 JSON: how the file was made; owner kNoOwner
  kBlob = 9,        // BlobHeader and a compressed file (format/blob.h); owner kNoOwner
  // A scene (format/scene_record.h); owner kNoOwner unless said otherwise.
  kScene = 10,          // SceneRecord
  kSceneNodes = 11,     // Wide8Node[] over the static instances
  kInstances = 12,      // InstanceRecord[]
  kPoses = 13,          // f32[12] or f64[12] per instance
  kLayers = 14,         // LayerRecord[]
  kMaterials = 15,      // MaterialRecord[]
  kMaterialRuns = 16,   // owner: a tree; FaceRun[] (format/face_numbers.h)
  kFaceMaterials = 17,  // owner: a tree; material of each face in tree order
  kLeftOut = 18,        // LeftOutRecord[]
  kDuplicates = 19,     // owner: a tree; the face of which each duplicate is a copy
  kActiveEdges = 20,    // owner: a tree; which edges are active (format/active_edges.h)
  kInstanceEdges = 21,  // edges where instances meet (format/instance_edges.h)
  kUserDataRuns = 22,   // owner: a tree; FaceRun[]
  kFaceUserData = 23,   // owner: a tree; user data of each face in tree order
  // A pack (format/pack.h); owner kNoOwner.
  kPack = 24,     // PackRow[], one per tree
  kMembers = 25,  // whole .bxt files, each at a multiple of kLargeAlignment in the section
};

/// "nodes"; "unknown" for a kind this reader does not know.
[[nodiscard]] std::string_view section_name(SectionKind kind) noexcept;

/// SectionEntry::owner of sections that belong to the whole file. They precede those of trees.
inline constexpr std::uint32_t kNoOwner = 0xffffffffu;

/// A row of the section table. From the least significant bit on, `word` holds 40 bits of the size,
/// 1 bit: readers that do not know the kind must refuse the file, 7 bits of the kind, and 16 bits
/// of the number of the tree that the section belongs to plus one, or 0. What is above the size
/// ascends strictly but for the bit in between.
struct SectionRow {
  std::uint64_t word;
  std::uint64_t checksum;  // XXH3-64 of the section's bytes
};
static_assert(sizeof(SectionRow) == 16 && std::is_trivially_copyable_v<SectionRow>);

/// What a row says, and where its section lies.
struct SectionEntry {
  SectionKind kind{};
  bool is_required = false;  // by readers that do not know the kind
  std::uint32_t owner = kNoOwner;
  std::uint64_t offset = 0;  // from the start of the file
  std::uint64_t size = 0;    // bytes, without the zero padding up to the next section
  std::uint64_t checksum = 0;

  /// `previous_end`: of the previous section, or of the table.
  [[nodiscard]] static SectionEntry of(const SectionRow& row, std::uint64_t previous_end) noexcept;
  /// Precondition: size < 2^40, owner < kMaxTrees or kNoOwner.
  [[nodiscard]] SectionRow row() const noexcept;
  /// Sections are in the order of this.
  [[nodiscard]] std::uint64_t key() const noexcept;
  [[nodiscard]] std::uint64_t end() const noexcept { return offset + size; }
};

/// Where a section begins whose predecessor ends there: a large one at a cache line.
[[nodiscard]] constexpr std::uint64_t section_begin(std::uint64_t previous_end,
                                                    std::uint64_t size) noexcept {
  return align_up(previous_end, size < kLargeSection ? kSmallAlignment : kLargeAlignment);
}

/// Where a file ends whose last section, or table, ends there.
[[nodiscard]] constexpr std::uint64_t file_end(std::uint64_t last_end) noexcept {
  return align_up(last_end, kSmallAlignment);
}

/// Where the section table of so many sections ends.
[[nodiscard]] constexpr std::uint64_t table_end(std::uint64_t sections) noexcept {
  return sizeof(FileHeader) + sections * sizeof(SectionRow);
}

/// A file whose header and section table passed every check of check_container().
struct Container {
  FileHeader header;
  Array<SectionEntry> sections;  // ascending by key()

  /// The section of that kind and owner, or nullptr.
  [[nodiscard]] const SectionEntry* find(SectionKind kind, std::uint32_t owner) const noexcept;
};

/// Computes XXH3-64. A parameter, because format/ links no library.
using ChecksumFunction = std::uint64_t (*)(Bytes head, Bytes tail);

/// The header of a file with this section table. `features`: its incompatible features. For
/// writers.
[[nodiscard]] FileHeader make_header(std::span<const SectionRow> table, std::uint32_t features,
                                     ChecksumFunction checksum) noexcept;

/// Reads and checks the header and section table: magic, version, features, checksum, that sections
/// are known or optional and in their order, and that they are as long as the file. Reads no
/// section: O(sections). Safe on any bytes; returns the first violation. `known_features`: bits of
/// incompatible_features that the caller can read; none for a file that is mapped. `memory`: of the
/// table.
Result<Container> check_container(Bytes file, ChecksumFunction checksum,
                                  std::uint32_t known_features = 0, const Memory* memory = nullptr);

/// Checks that the bytes between sections, and after the last one, are zero; the error names the
/// first that is not.
Status check_padding(Bytes file, const Container& container);

}  // namespace boxtree
