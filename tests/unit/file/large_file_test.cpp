// SPDX-License-Identifier: MIT
// A file of more than 4 GiB: one section, which readers do not know and skip, takes up five, and
// the sections of the tree lie behind it. The file has a hole there, where the system makes some.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "format/container.h"
#include "runtime/file/checksum.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/temp_folder.h"

namespace boxtree {
namespace {

constexpr std::uint64_t kFiveGiB = std::uint64_t{5} << 30;

struct Section {
  SectionEntry entry;
  std::vector<std::byte> bytes;  // of those that are known
};

std::vector<Section> sections_of(const std::vector<std::byte>& file) {
  FileHeader header;
  std::memcpy(&header, file.data(), sizeof header);
  std::vector<Section> sections;
  std::uint64_t end = table_end(header.section_count);
  for (std::uint32_t i = 0; i < header.section_count; ++i) {
    SectionRow row;
    std::memcpy(&row, file.data() + sizeof header + i * sizeof row, sizeof row);
    const SectionEntry entry = SectionEntry::of(row, end);
    const std::byte* const begin = file.data() + entry.offset;
    sections.push_back({entry, {begin, begin + entry.size}});
    end = entry.end();
  }
  return sections;
}

// Returns how long the file is.
std::uint64_t write(const std::filesystem::path& path, const std::vector<Section>& sections) {
  std::vector<SectionRow> table;
  for (const Section& section : sections) table.push_back(section.entry.row());
  const FileHeader header = make_header(table, 0, checksum);
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(&header), sizeof header);
  out.write(reinterpret_cast<const char*>(table.data()),
            static_cast<std::streamsize>(table.size() * sizeof table[0]));
  std::uint64_t end = table_end(table.size());
  for (const Section& section : sections) {
    const std::uint64_t begin = section_begin(end, section.entry.size);
    out.seekp(static_cast<std::streamoff>(begin));
    out.write(reinterpret_cast<const char*>(section.bytes.data()),
              static_cast<std::streamsize>(section.bytes.size()));
    end = begin + section.entry.size;
  }
  const std::uint64_t size = file_end(end);
  for (; end < size; ++end) out.put('\0');
  EXPECT_TRUE(out.good());
  return size;
}

TEST(LargeFile, SectionsBeyond4GiBAreRead) {
  if (sizeof(std::size_t) < 8) GTEST_SKIP() << "no such file fits into memory of 32 bits";
  const std::vector<std::byte> small = test::cook_bytes(test::torus(40, 30), CodecId::kWide8);
  std::vector<Section> sections = sections_of(small);
  const auto first_of_tree =
      std::find_if(sections.begin(), sections.end(),
                   [](const Section& each) { return each.entry.owner != kNoOwner; });
  ASSERT_NE(first_of_tree, sections.end());
  Section unknown;
  unknown.entry.kind = static_cast<SectionKind>(100);
  unknown.entry.size = kFiveGiB;
  sections.insert(first_of_tree, unknown);
  const test::TempFolder folder;
  const std::filesystem::path path = folder.path() / "large.bxt";
  ASSERT_GT(write(path, sections), kFiveGiB);

  const File file = test::require(File::open(path.string()));
  const Tree tree = test::require(Tree::bind(file));
  const File expected_file = test::require(File::open(Bytes(small)));
  const Tree expected = test::require(Tree::bind(expected_file));
  int hits = 0;
  for (int i = 0; i < 200; ++i) {
    const Ray ray{{0.02 * i - 2, 0.013 * i - 1.3, 9}, {0, 0, -1}};
    const auto a = closest_hit(tree, ray), b = closest_hit(expected, ray);
    ASSERT_EQ(a.code(), b.code());
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a) continue;
    ++hits;
    EXPECT_EQ(a->t, b->t);
    EXPECT_EQ(a->face.id, b->face.id);
  }
  EXPECT_GT(hits, 20);
  EXPECT_EQ(closest_point(tree, {1, 2, 3})->distance, closest_point(expected, {1, 2, 3})->distance);
}

}  // namespace
}  // namespace boxtree
