// SPDX-License-Identifier: MIT
// Cooked files in memory, for tests that start from a mesh and end at a tree.
#pragma once

#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "cooker/cook.h"
#include "format/container.h"

namespace boxtree::test {

/// The bytes of a file with one tree, in one codec.
[[nodiscard]] std::vector<std::byte> cook_bytes(const cooker::SourceMesh& mesh, CodecId codec,
                                                const cooker::CookOptions& options = {});

/// A tree together with the bytes it points into.
struct CookedTree {
  std::vector<std::byte> bytes;
  File file;
  Tree tree;
};

/// Cooks, opens and binds; a failure is a failed test and throws, as nothing can follow it.
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

/// Every codec with exact geometry and on a grid, and the names of such tests.
[[nodiscard]] std::vector<Encoding> all_encodings();
[[nodiscard]] std::string encoding_name(const testing::TestParamInfo<Encoding>& info);

/// Cooks into an encoding; a grid has 16 bits.
[[nodiscard]] CookedTree cook_tree(const cooker::SourceMesh& mesh, const Encoding& encoding);

/// Every triangle of a tree, in tree space, by the public way down.
[[nodiscard]] std::vector<Triangle> all_triangles(const Tree& tree);

/// "plain_f32" for "plain-f32": test names allow no dashes.
[[nodiscard]] std::string test_name(const testing::TestParamInfo<CodecId>& info);

/// The entry of a section of a file with one of the kind.
[[nodiscard]] SectionEntry entry_of(const std::vector<std::byte>& file, SectionKind kind);

/// Changes each record of a section, given its number and how many there are, and makes the
/// checksums right again: bytes that lie.
template <class Record>
void edit_records(std::vector<std::byte>& file, SectionKind kind,
                  const std::function<void(Record&, std::uint32_t, std::uint32_t)>& change);

/// Makes the checksums of header and sections right again after a change, so that the checks
/// behind them are reached.
void repair_checksums(std::vector<std::byte>& bytes);

template <class Record>
void edit_records(std::vector<std::byte>& file, SectionKind kind,
                  const std::function<void(Record&, std::uint32_t, std::uint32_t)>& change) {
  const SectionEntry entry = entry_of(file, kind);
  const auto count = static_cast<std::uint32_t>(entry.size / sizeof(Record));
  for (std::uint32_t i = 0; i < count; ++i) {
    std::byte* const at = file.data() + entry.offset + i * sizeof(Record);
    auto record = load<Record>(at);
    change(record, i, count);
    std::memcpy(at, &record, sizeof(record));
  }
  repair_checksums(file);
}

}  // namespace boxtree::test
