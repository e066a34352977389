// SPDX-License-Identifier: MIT
// Each lie that a header, a section table or a tree record can tell, and the code that it earns.
#include "format/container.h"

#include <cstring>
#include <functional>

#include <gtest/gtest.h>

#include "cooker/proof/proof.h"
#include "format/tree_record.h"
#include "runtime/file/open_file.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"

namespace boxtree {
namespace {

using FileBytes = std::vector<std::byte>;

template <class Record>
void edit(FileBytes& bytes, std::size_t offset, const std::function<void(Record&)>& change) {
  auto record = load<Record>(bytes.data() + offset);
  change(record);
  std::memcpy(bytes.data() + offset, &record, sizeof(record));
}

void edit_header(FileBytes& bytes, const std::function<void(FileHeader&)>& change) {
  edit<FileHeader>(bytes, 0, change);
}
void edit_section(FileBytes& bytes, std::size_t index,
                  const std::function<void(SectionEntry&)>& change) {
  SectionEntry entry = test::sections_of(bytes)[index];
  change(entry);
  edit<SectionRow>(bytes, table_end(index), [&](SectionRow& row) { row = entry.row(); });
}
void edit_record(FileBytes& bytes, const std::function<void(TreeRecord&)>& change) {
  edit<TreeRecord>(bytes, test::sections_of(bytes).front().offset, change);
}

FileBytes valid_file() {
  return test::cook_bytes(test::city(2, 1), CodecId::kPlainF32);
}

std::size_t section_index(const FileBytes& bytes, SectionKind kind) {
  const Result<File> file = File::open(Bytes(bytes));
  const auto& sections = OpenFile::of(*file).container().sections;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    if (sections[i].kind == kind) return i;
  }
  ADD_FAILURE() << "no such section";
  return 0;
}

struct Lie {
  const char* name;
  Errc expected;
  std::function<void(FileBytes&)> tell;
};

// Named in messages by their first member.
void PrintTo(const Lie& lie, std::ostream* out) {
  *out << lie.name;
}

class ContainerLies : public testing::TestWithParam<Lie> {};

TEST_P(ContainerLies, AreFoundWhenOpening) {
  FileBytes bytes = valid_file();
  GetParam().tell(bytes);
  test::repair_checksums(bytes);
  EXPECT_EQ(File::open(Bytes(bytes)).code(), GetParam().expected);
}

INSTANTIATE_TEST_SUITE_P(
    Header, ContainerLies,
    testing::Values(
        Lie{"magic", Errc::kBadMagic,
            [](FileBytes& b) { edit_header(b, [](FileHeader& h) { h.magic[4] = '\n'; }); }},
        Lie{"newer_major", Errc::kVersionUnsupported,
            [](FileBytes& b) { edit_header(b, [](FileHeader& h) { h.version_major = 2; }); }},
        Lie{"feature", Errc::kFeatureUnsupported,
            [](FileBytes& b) {
              edit_header(b, [](FileHeader& h) { h.incompatible_features = 1u << 30; });
            }},
        Lie{"too_many_sections", Errc::kTooManySections,
            [](FileBytes& b) {
              edit_header(b, [](FileHeader& h) { h.section_count = kMaxSections + 1; });
            }},
        Lie{"table_outside", Errc::kTruncated,
            [](FileBytes& b) { edit_header(b, [](FileHeader& h) { h.section_count = 60000; }); }}),
    [](const auto& lie) { return std::string(lie.param.name); });

INSTANTIATE_TEST_SUITE_P(
    Sections, ContainerLies,
    testing::Values(
        Lie{"longer_than_the_file", Errc::kTruncated,
            [](FileBytes& b) {
              const std::size_t last = load<FileHeader>(b.data()).section_count - 1;
              edit_section(b, last, [](SectionEntry& s) { s.size = (1ull << 40) - 1; });
            }},
        Lie{"shorter_than_the_file", Errc::kTruncated,
            [](FileBytes& b) {
              const std::size_t last = load<FileHeader>(b.data()).section_count - 1;
              edit_section(b, last, [](SectionEntry& s) { s.size -= 8; });
            }},
        Lie{"twice", Errc::kSectionOrder,
            [](FileBytes& b) {
              const SectionEntry first = test::sections_of(b).front();
              edit_section(b, 1, [&](SectionEntry& s) {
                s.kind = first.kind;
                s.owner = first.owner;
              });
            }},
        Lie{"of_a_tree_before_the_file", Errc::kSectionOrder,
            [](FileBytes& b) { edit_section(b, 0, [](SectionEntry& s) { s.owner = 9; }); }},
        Lie{"unknown_but_required", Errc::kSectionUnknown,
            [](FileBytes& b) {
              const std::size_t last = load<FileHeader>(b.data()).section_count - 1;
              edit_section(b, last, [](SectionEntry& s) {
                s.kind = static_cast<SectionKind>(99);
                s.is_required = true;
              });
            }},
        Lie{"no_trees", Errc::kSectionMissing,
            [](FileBytes& b) {
              edit_section(b, 0, [](SectionEntry& s) {
                s.kind = static_cast<SectionKind>(0);
                s.is_required = false;
              });
            }},
        Lie{"half_a_record", Errc::kSectionSize,
            [](FileBytes& b) { edit_section(b, 0, [](SectionEntry& s) { s.size -= 1; }); }}),
    [](const auto& lie) { return std::string(lie.param.name); });

TEST(Container, UnknownOptionalSectionsAndNewerMinorsAreRead) {
  FileBytes bytes = valid_file();
  edit_section(bytes, section_index(bytes, SectionKind::kFaceIds), [](SectionEntry& s) {
    s.kind = static_cast<SectionKind>(99);
    s.is_required = false;
  });
  edit_header(bytes, [](FileHeader& h) {
    h.version_minor = 7;
    h.compatible_features = 1;
  });
  test::repair_checksums(bytes);
  const Result<File> file = File::open(Bytes(bytes));
  ASSERT_TRUE(file.ok()) << file.error().message();
  EXPECT_TRUE(Tree::bind(*file).ok());
}

// Sections of at least 4096 bytes begin at a cache line, others at eight bytes.
TEST(Container, LargeSectionsBeginAtACacheLine) {
  EXPECT_EQ(section_begin(1, 4095), 8u);
  EXPECT_EQ(section_begin(1, 4096), 64u);
  EXPECT_EQ(section_begin(64, 4096), 64u);
  EXPECT_EQ(section_begin(65, 1), 72u);
  EXPECT_EQ(file_end(65), 72u);
}

// The bits of docs/FORMAT.md, section 2, as literals.
TEST(Container, RowsAreAsSpecified) {
  SectionEntry entry;
  entry.kind = SectionKind::kDuplicates;
  entry.is_required = true;
  entry.owner = 2;
  entry.size = 0x1234567890;
  entry.checksum = 7;
  EXPECT_EQ(entry.row().word, 0x0003'27'1234567890u);
  EXPECT_EQ(entry.row().checksum, 7u);
  entry.owner = kNoOwner;
  entry.kind = SectionKind::kTrees;
  entry.is_required = false;
  EXPECT_EQ(entry.row().word, 0x0000'02'1234567890u);
  const SectionEntry read = SectionEntry::of({0x0003'27'0000000010u, 7}, 33);
  EXPECT_EQ(read.kind, SectionKind::kDuplicates);
  EXPECT_TRUE(read.is_required);
  EXPECT_EQ(read.owner, 2u);
  EXPECT_EQ(read.offset, 40u);
  EXPECT_EQ(read.end(), 56u);
}

// What precedes the section that a reader does not know is found, and what follows it.
TEST(Container, CutAtEveryByteAndPaddedItIsRefused) {
  const FileBytes bytes = valid_file();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    ASSERT_FALSE(File::open(Bytes(bytes).first(size)).ok()) << size;
  }
  EXPECT_EQ(File::open(Bytes(bytes).first(bytes.size() - 8)).error().message(),
            "truncated: the file lacks 8 bytes");
  FileBytes longer = bytes;
  longer.resize(bytes.size() + 8);
  EXPECT_EQ(File::open(Bytes(longer)).error().message(),
            "truncated: the file has 8 bytes after its end");
}

TEST(Container, PaddingMustBeZero) {
  FileBytes bytes = valid_file();
  const Result<File> file = File::open(Bytes(bytes));
  EXPECT_TRUE(check_padding(Bytes(bytes), OpenFile::of(*file).container()).ok());
  std::uint64_t end = table_end(test::sections_of(bytes).size());
  for (const SectionEntry& entry : test::sections_of(bytes)) {
    if (entry.offset > end) break;
    end = entry.end();
  }
  bytes[end] = std::byte{1};
  EXPECT_EQ(check_padding(Bytes(bytes), OpenFile::of(*file).container()).code(),
            Errc::kPaddingNotZero);
}

TEST(Container, SectionChecksumsAreCheckedOnDemand) {
  FileBytes bytes = valid_file();
  const SectionEntry nodes = OpenFile::of(*File::open(Bytes(bytes)))
                                 .container()
                                 .sections[section_index(bytes, SectionKind::kNodes)];
  bytes[nodes.offset + nodes.size - 1] ^= std::byte{1};
  EXPECT_TRUE(File::open(Bytes(bytes)).ok());
  OpenOptions options;
  options.verify_checksums = true;
  EXPECT_EQ(File::open(Bytes(bytes), options).code(), Errc::kChecksumMismatch);
}

class RecordLies : public testing::TestWithParam<Lie> {};

TEST_P(RecordLies, AreFoundWhenBinding) {
  FileBytes bytes = valid_file();
  GetParam().tell(bytes);
  test::repair_checksums(bytes);
  const Result<File> file = File::open(Bytes(bytes));
  ASSERT_TRUE(file.ok()) << file.error().message();
  EXPECT_EQ(Tree::bind(*file).code(), GetParam().expected);
}

Lie record_lie(const char* name, Errc expected, void (*change)(TreeRecord&)) {
  return {name, expected, [change](FileBytes& b) { edit_record(b, change); }};
}

INSTANTIATE_TEST_SUITE_P(
    Record, RecordLies,
    testing::Values(
        record_lie("codec", Errc::kCodecUnsupported,
                   [](TreeRecord& r) { r.codec = static_cast<CodecId>(77); }),
        record_lie("geometry", Errc::kGeometryUnsupported,
                   [](TreeRecord& r) { r.geometry = static_cast<GeometryId>(77); }),
        record_lie("flags", Errc::kFeatureUnsupported, [](TreeRecord& r) { r.flags |= 1u << 7; }),
        record_lie("error", Errc::kRecordInvalid,
                   [](TreeRecord& r) {
                     r.max_vertex_error = std::numeric_limits<double>::quiet_NaN();
                   }),
        record_lie("degenerate", Errc::kRecordInvalid,
                   [](TreeRecord& r) { r.degenerate_count = r.triangle_count + 1; }),
        record_lie("grid_of_exact", Errc::kRecordInvalid,
                   [](TreeRecord& r) { r.grid_exponent = 1; }),
        record_lie("grid_of_bytes", Errc::kRecordInvalid,
                   [](TreeRecord& r) { r.geometry = GeometryId::kGrid; }),
        record_lie("too_deep", Errc::kRecordInvalid,
                   [](TreeRecord& r) { r.depth = kMaxDepth + 1; }),
        record_lie("root_kind", Errc::kRecordInvalid,
                   [](TreeRecord& r) { r.root = static_cast<RootKind>(9); }),
        record_lie("root_box", Errc::kRecordInvalid,
                   [](TreeRecord& r) { std::swap(r.root_low, r.root_high); }),
        record_lie("root_box_too_large", Errc::kRecordInvalid,
                   [](TreeRecord& r) { r.root_high[0] = 1e300; }),
        record_lie("origin", Errc::kRecordInvalid,
                   [](TreeRecord& r) { r.origin[1] = std::numeric_limits<double>::quiet_NaN(); }),
        record_lie("scale", Errc::kRecordInvalid, [](TreeRecord& r) { r.scale_exponent = 2000; }),
        record_lie("triangles", Errc::kRecordInvalid, [](TreeRecord& r) { r.triangle_count = 1; }),
        record_lie("corner_bytes", Errc::kRecordInvalid, [](TreeRecord& r) { r.corner_bytes = 3; }),
        record_lie("face_ids", Errc::kRecordInvalid,
                   [](TreeRecord& r) { r.flags |= kTreeFacesInSourceOrder; }),
        record_lie("nodes_missing", Errc::kSectionSize, [](TreeRecord& r) { r.node_count += 1; })),
    [](const auto& lie) { return std::string(lie.param.name); });

TEST(Record, WithoutASectionItNeedsItIsRefused) {
  FileBytes bytes = valid_file();
  const std::size_t last = test::sections_of(bytes).size() - 1;
  ASSERT_EQ(section_index(bytes, SectionKind::kFaceIds), last);
  for (const std::size_t i : {last, last - 1}) {  // corners precede them
    edit_section(bytes, i, [i](SectionEntry& s) {
      s.kind = static_cast<SectionKind>(90 + i);
      s.is_required = false;
    });
  }
  test::repair_checksums(bytes);
  const Result<File> file = File::open(Bytes(bytes));
  EXPECT_EQ(Tree::bind(*file).code(), Errc::kSectionMissing);
}

TEST(Record, VerticesAreAWholeNumber) {
  cooker::EncodedTree tree = test::require(cooker::cook_as(test::city(2, 1), CodecId::kPlainF32));
  ASSERT_EQ(tree.geometry.geometry, GeometryId::kArrays);
  EXPECT_TRUE(cooker::bind_encoded(tree).ok());
  tree.geometry.vertices.resize(tree.geometry.vertices.size() - 1);
  EXPECT_EQ(cooker::bind_encoded(tree).code(), Errc::kSectionSize);
  tree.geometry.vertices.clear();
  EXPECT_EQ(cooker::bind_encoded(tree).code(), Errc::kSectionMissing);
}

}  // namespace
}  // namespace boxtree
