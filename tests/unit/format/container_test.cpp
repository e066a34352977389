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
  edit<SectionEntry>(bytes, sizeof(FileHeader) + index * sizeof(SectionEntry), change);
}
void edit_record(FileBytes& bytes, const std::function<void(TreeRecord&)>& change) {
  const auto trees = load<SectionEntry>(bytes.data() + sizeof(FileHeader));
  edit<TreeRecord>(bytes, trees.offset, change);
}

FileBytes valid_file() {
  return test::cook_bytes(test::city(2, 1), CodecId::kPlainF32);
}

std::size_t section_index(const FileBytes& bytes, SectionKind kind) {
  const Result<File> file = File::open(Bytes(bytes));
  const auto& sections = OpenFile::of(*file).container().sections;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    if (sections[i].kind == static_cast<std::uint32_t>(kind)) return i;
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
              edit_header(b, [](FileHeader& h) { h.incompatible_features = 1ull << 40; });
            }},
        Lie{"reserved", Errc::kHeaderCorrupt,
            [](FileBytes& b) { edit_header(b, [](FileHeader& h) { h.reserved1 = 1; }); }},
        Lie{"header_bytes", Errc::kHeaderCorrupt,
            [](FileBytes& b) { edit_header(b, [](FileHeader& h) { h.header_bytes = 128; }); }},
        Lie{"larger_than_it_is", Errc::kTruncated,
            [](FileBytes& b) { edit_header(b, [](FileHeader& h) { h.file_bytes += 64; }); }},
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
        Lie{"misaligned", Errc::kSectionMisaligned,
            [](FileBytes& b) { edit_section(b, 1, [](SectionEntry& s) { s.offset += 32; }); }},
        Lie{"overlap", Errc::kSectionOverlap,
            [](FileBytes& b) { edit_section(b, 1, [](SectionEntry& s) { s.offset -= 64; }); }},
        Lie{"gap", Errc::kSectionOverlap,
            [](FileBytes& b) { edit_section(b, 1, [](SectionEntry& s) { s.offset += 64 * 65; }); }},
        Lie{"outside", Errc::kSectionOutOfRange,
            [](FileBytes& b) {
              const std::size_t last = load<FileHeader>(b.data()).section_count - 1;
              edit_section(b, last, [](SectionEntry& s) { s.size = ~std::uint64_t{0}; });
            }},
        Lie{"duplicate", Errc::kSectionDuplicate,
            [](FileBytes& b) {
              const SectionEntry first = load<SectionEntry>(b.data() + sizeof(FileHeader));
              edit_section(b, 1, [&](SectionEntry& s) {
                s.kind = first.kind;
                s.owner = first.owner;
              });
            }},
        Lie{"unknown_but_required", Errc::kSectionUnknown,
            [](FileBytes& b) {
              edit_section(b, 1, [](SectionEntry& s) {
                s.kind = 999;
                s.flags = kSectionRequired;
              });
            }},
        Lie{"unknown_flag", Errc::kHeaderCorrupt,
            [](FileBytes& b) { edit_section(b, 1, [](SectionEntry& s) { s.flags |= 2; }); }},
        Lie{"no_trees", Errc::kSectionMissing,
            [](FileBytes& b) {
              edit_section(b, 0, [](SectionEntry& s) {
                s.kind = 999;
                s.flags = 0;
              });
            }},
        Lie{"half_a_record", Errc::kSectionSize,
            [](FileBytes& b) { edit_section(b, 0, [](SectionEntry& s) { s.size -= 1; }); }}),
    [](const auto& lie) { return std::string(lie.param.name); });

TEST(Container, UnknownOptionalSectionsAndNewerMinorsAreRead) {
  FileBytes bytes = valid_file();
  edit_section(bytes, section_index(bytes, SectionKind::kCertificate), [](SectionEntry& s) {
    s.kind = 999;
    s.flags = 0;
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

// As many zero bytes as there may be between two sections, and 64 more.
TEST(Container, GapsHaveABound) {
  const FileBytes original = valid_file();
  const auto header = load<FileHeader>(original.data());
  const auto entry = [&original](std::size_t i) {
    return load<SectionEntry>(original.data() + sizeof(FileHeader) + i * sizeof(SectionEntry));
  };
  std::size_t behind = 1;  // the first section whose predecessor ends where it may begin itself
  while (behind < header.section_count && entry(behind - 1).size % kSectionAlignment != 0) ++behind;
  ASSERT_LT(behind, header.section_count);
  for (const std::uint64_t gap : {kMaxSectionGap, kMaxSectionGap + kSectionAlignment}) {
    FileBytes bytes = original;
    bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(entry(behind).offset), gap,
                 std::byte{0});
    for (std::size_t i = behind; i < header.section_count; ++i) {
      edit_section(bytes, i, [gap](SectionEntry& s) { s.offset += gap; });
    }
    edit_header(bytes, [gap](FileHeader& h) { h.file_bytes += gap; });
    test::repair_checksums(bytes);
    EXPECT_EQ(File::open(Bytes(bytes)).code(),
              gap == kMaxSectionGap ? Errc::kOk : Errc::kSectionOverlap)
        << gap;
  }
}

TEST(Container, PaddingMustBeZero) {
  FileBytes bytes = valid_file();
  const Result<File> file = File::open(Bytes(bytes));
  EXPECT_TRUE(check_padding(Bytes(bytes), OpenFile::of(*file).container()).ok());
  bytes.back() = std::byte{1};
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
                   [](TreeRecord& r) { r.codec = static_cast<CodecId>(777); }),
        record_lie("geometry", Errc::kGeometryUnsupported,
                   [](TreeRecord& r) { r.geometry = static_cast<GeometryId>(777); }),
        record_lie("flags", Errc::kFeatureUnsupported, [](TreeRecord& r) { r.flags |= 1u << 31; }),
        record_lie("reserve", Errc::kRecordInvalid, [](TreeRecord& r) { r.reserved2[6] = 1; }),
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
        record_lie("face_ids", Errc::kRecordInvalid, [](TreeRecord& r) { r.has_face_ids = 2; }),
        record_lie("face_ids_that_are_there", Errc::kSectionSize,
                   [](TreeRecord& r) { r.has_face_ids = 0; }),
        record_lie("nodes_missing", Errc::kSectionSize, [](TreeRecord& r) { r.node_count += 1; }),
        record_lie("vertices_missing", Errc::kSectionSize,
                   [](TreeRecord& r) { r.vertex_count += 1; })),
    [](const auto& lie) { return std::string(lie.param.name); });

TEST(Record, WithoutASectionItNeedsItIsRefused) {
  FileBytes bytes = valid_file();
  edit_section(bytes, section_index(bytes, SectionKind::kVertices), [](SectionEntry& s) {
    s.kind = 999;
    s.flags = 0;
  });
  test::repair_checksums(bytes);
  const Result<File> file = File::open(Bytes(bytes));
  EXPECT_EQ(Tree::bind(*file).code(), Errc::kSectionMissing);
}

}  // namespace
}  // namespace boxtree
