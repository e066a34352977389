// SPDX-License-Identifier: MIT
// The container of a .bxt file: header, section table, and the checks of both. Layouts are the
// specification; docs/FORMAT.md explains them in words. Version log:
//   1.0  header, section table, codecs plain-f32 and plain-f16, geometry exact and external
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include <boxtree/error.h>

#include "format/bytes.h"
#include "format/limits.h"

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
  std::uint32_t header_bytes;   // 64
  std::uint64_t file_bytes;
  std::uint64_t incompatible_features;  // a reader refuses bits it does not know
  std::uint64_t compatible_features;    // a reader ignores bits it does not know
  std::uint32_t section_count;
  std::uint32_t reserved0;  // zero
  std::uint64_t reserved1;  // zero
  std::uint64_t checksum;   // XXH3-64 of the 56 bytes before it and the whole section table
};
static_assert(sizeof(FileHeader) == 64 && std::is_trivially_copyable_v<FileHeader>);
static_assert(offsetof(FileHeader, file_bytes) == 16 && offsetof(FileHeader, section_count) == 40);
static_assert(offsetof(FileHeader, checksum) == 56);

/// What a section holds. Numbers are pinned.
enum class SectionKind : std::uint32_t {
  kTrees = 1,        // TreeRecord[], one per tree; owner kNoOwner
  kNodes = 2,        // the codec's nodes
  kVertices = 3,     // geometry exact: positions; grid: the bytes of clusters
  kCorners = 4,      // geometry exact: vertex numbers of each face; grid: ClusterRecord[]
  kFaceIds = 5,      // source face number of each face
  kCertificate = 6,  // CertificateRecord
  kNames = 7,        // UTF-8 names of all trees, joined; owner kNoOwner
  kCookRecord = 8,   // UTF-8 JSON: how the file was made; owner kNoOwner
  kBlob = 9,         // BlobHeader and a compressed file (format/blob.h); owner kNoOwner
  // A scene (format/scene_record.h); owner kNoOwner unless said otherwise.
  kScene = 10,          // SceneRecord
  kSceneNodes = 11,     // Wide8Node[] over the static instances
  kInstances = 12,      // InstanceRecord[]
  kPoses = 13,          // f32[12] or f64[12] per instance
  kLayers = 14,         // LayerRecord[]
  kMaterials = 15,      // MaterialRecord[]
  kMaterialRuns = 16,   // owner: a tree; MaterialRun[]
  kFaceMaterials = 17,  // owner: a tree; material of each face in tree order
  kLeftOut = 18,        // LeftOutRecord[]
  kDuplicates = 19,     // owner: a tree; the face of which each duplicate is a copy
};

/// "nodes"; "unknown" for a kind this reader does not know.
[[nodiscard]] std::string_view section_name(SectionKind kind) noexcept;

/// Set in SectionEntry::flags when a reader that does not know the kind must refuse the file.
inline constexpr std::uint32_t kSectionRequired = 1u;

/// SectionEntry::owner of sections that belong to the whole file.
inline constexpr std::uint32_t kNoOwner = 0xffffffffu;

struct SectionEntry {
  std::uint32_t kind;
  std::uint32_t flags;     // kSectionRequired; other bits zero
  std::uint32_t owner;     // number of the tree it belongs to, or kNoOwner
  std::uint32_t reserved;  // zero
  std::uint64_t offset;    // from the start of the file, multiple of 64, ascending
  std::uint64_t size;      // bytes, without the zero padding up to the next section
  std::uint64_t checksum;  // XXH3-64 of the section's bytes
};
static_assert(sizeof(SectionEntry) == 40 && std::is_trivially_copyable_v<SectionEntry>);
static_assert(offsetof(SectionEntry, offset) == 16 && offsetof(SectionEntry, checksum) == 32);

/// A file whose header and section table passed every check of check_container().
struct Container {
  FileHeader header;
  std::vector<SectionEntry> sections;
  std::vector<std::uint32_t> by_kind_and_owner;  // numbers of sections, sorted

  /// The section of that kind and owner, or nullptr.
  [[nodiscard]] const SectionEntry* find(SectionKind kind, std::uint32_t owner) const noexcept;
};

/// Computes XXH3-64. A parameter, because format/ links no library.
using ChecksumFunction = std::uint64_t (*)(Bytes head, Bytes tail);

/// The header of a file with these sections, which ends after the last one. `features`: its
/// incompatible features. For writers.
[[nodiscard]] FileHeader make_header(std::span<const SectionEntry> sections, std::uint64_t features,
                                     ChecksumFunction checksum) noexcept;

/// Reads and checks the header and section table: magic, version, features, size, checksum, and
/// that sections are known or optional, aligned, ascending, disjoint and inside the file. Reads no
/// section: O(sections). Safe on any bytes; returns the first violation. `known_features`: bits of
/// incompatible_features that the caller can read; none for a file that is mapped.
Result<Container> check_container(Bytes file, ChecksumFunction checksum,
                                  std::uint64_t known_features = 0);

/// Checks that the bytes between sections, and after the last one, are zero; the error names the
/// first that is not.
Status check_padding(Bytes file, const Container& container);

}  // namespace boxtree
