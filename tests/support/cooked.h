// SPDX-License-Identifier: MIT
// Cooks meshes to files in memory and binds their trees.
#pragma once

#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "cooker/cook.h"
#include "format/container.h"

namespace boxtree::test {

/// The bytes of a file with one tree in one codec.
[[nodiscard]] std::vector<std::byte> cook_bytes(const cooker::SourceMesh& mesh, CodecId codec,
                                                const cooker::CookOptions& options = {});

/// The bytes of a file with one tree and the user data of its faces, by runs as in Imported.
[[nodiscard]] std::vector<std::byte> cook_bytes(const cooker::SourceMesh& mesh,
                                                const std::vector<FaceRun>& user_data,
                                                CodecId codec, cooker::CookOptions options = {});

/// The bytes of a file with one tree and the materials of its faces.
[[nodiscard]] std::vector<std::byte> cook_bytes(const cooker::SourceMesh& mesh,
                                                const cooker::FaceMaterials& materials,
                                                CodecId codec, cooker::CookOptions options = {});

/// A tree together with the bytes it points into.
struct CookedTree {
  std::vector<std::byte> bytes;
  File file;
  Tree tree;
};

/// Cooks, opens and binds. A failure fails the test and throws, because the test cannot continue.
[[nodiscard]] CookedTree cook_tree(const cooker::SourceMesh& mesh, CodecId codec,
                                   const cooker::CookOptions& options = {},
                                   const BindOptions& bind = {});

/// Every codec of the registry, for testing::ValuesIn.
[[nodiscard]] std::vector<CodecId> all_codecs();

/// A codec and a geometry store.
struct Encoding {
  CodecId codec;
  GeometryId geometry;
};

/// Every codec with exact geometry and on a grid.
[[nodiscard]] std::vector<Encoding> all_encodings();
[[nodiscard]] std::string encoding_name(const testing::TestParamInfo<Encoding>& info);

/// Cooks into an encoding; a grid has 16 bits.
[[nodiscard]] CookedTree cook_tree(const cooker::SourceMesh& mesh, const Encoding& encoding);

/// Every triangle of a tree, in tree space, read by the public traversal.
[[nodiscard]] std::vector<Triangle> all_triangles(const Tree& tree);

/// "plain_f32" for "plain-f32": test names allow no dashes.
[[nodiscard]] std::string test_name(const testing::TestParamInfo<CodecId>& info);

/// The section table entry of the file's section of a kind. Precondition: there is one.
[[nodiscard]] SectionEntry entry_of(const std::vector<std::byte>& file, SectionKind kind);

/// The bytes of that section.
[[nodiscard]] std::span<std::byte> section_of(std::vector<std::byte>& file, SectionKind kind);

/// The sections of a file that may be corrupt, in the order of its table: those that lie in it.
[[nodiscard]] std::vector<SectionEntry> sections_of(const std::vector<std::byte>& file);

/// Changes that entry and repairs the checksums.
void edit_entry(std::vector<std::byte>& file, SectionKind kind,
                const std::function<void(SectionEntry&)>& change);

/// Calls `change` for each record of a section, with its index and the number of records, and
/// repairs the checksums, to make corrupt files with valid checksums.
template <class Record>
void edit_records(std::vector<std::byte>& file, SectionKind kind,
                  const std::function<void(Record&, std::uint32_t, std::uint32_t)>& change);

/// Repairs the checksums of header and sections after a change, so that later checks are reached.
void repair_checksums(std::vector<std::byte>& bytes);

template <class Record>
void edit_records(std::vector<std::byte>& file, SectionKind kind,
                  const std::function<void(Record&, std::uint32_t, std::uint32_t)>& change) {
  const std::span<std::byte> section = section_of(file, kind);
  const auto count = static_cast<std::uint32_t>(section.size() / sizeof(Record));
  for (std::uint32_t i = 0; i < count; ++i) {
    std::byte* const at = section.data() + i * sizeof(Record);
    auto record = load<Record>(at);
    change(record, i, count);
    std::memcpy(at, &record, sizeof(record));
  }
  repair_checksums(file);
}

}  // namespace boxtree::test
