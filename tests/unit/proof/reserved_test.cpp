// SPDX-License-Identifier: MIT
// Bits that mean nothing and have to be zero: verify finds each of them in every codec and store,
// and none in files as they are written.
#include <algorithm>

#include <gtest/gtest.h>

#include <boxtree/cooker/proof/proof.h>
#include <boxtree/format/codec_packed.h>
#include <boxtree/format/codec_plain.h>
#include <boxtree/format/codec_wide.h>
#include <boxtree/format/grid.h>

#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"

namespace boxtree {
namespace {

using FileBytes = std::vector<std::byte>;

bool is_found(const FileBytes& bytes) {
  const File file = test::require(File::open(Bytes(bytes)));
  const cooker::Findings findings = cooker::verify_file(file);
  return std::any_of(findings.begin(), findings.end(),
                     [](const Error& finding) { return finding.code == Errc::kPaddingNotZero; });
}

// Sets the bits of `mask` in byte `at` of a section and takes them back.
bool is_found_at(FileBytes bytes, SectionKind kind, std::uint64_t at, unsigned mask) {
  const SectionEntry entry = test::entry_of(bytes, kind);
  bytes[entry.offset + at] |= static_cast<std::byte>(mask);
  test::repair_checksums(bytes);
  return is_found(bytes);
}

class Reserved : public testing::TestWithParam<test::Encoding> {};

TEST_P(Reserved, NothingIsSetInWhatIsWritten) {
  for (const cooker::SourceMesh& mesh :
       {test::torus(24, 12), test::city(12, 2), test::soup(3, 1), test::soup(1000, 2)}) {
    const test::CookedTree cooked = test::cook_tree(mesh, GetParam());
    EXPECT_TRUE(cooker::verify_file(cooked.file).empty()) << mesh.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Encodings, Reserved, testing::ValuesIn(test::all_encodings()),
                         test::encoding_name);

template <class Node>
void expect_found_in_wide_nodes(CodecId codec) {
  const FileBytes bytes = test::cook_bytes(test::soup(1000, 2), codec);
  const SectionEntry entry = test::entry_of(bytes, SectionKind::kNodes);
  std::size_t unused = 0;
  for (std::size_t n = 0; n < entry.size / sizeof(Node); ++n) {
    const auto node = load<Node>(bytes.data() + entry.offset, n);
    const std::uint32_t count = links_of(node).child_count;
    for (std::size_t axis = 0; axis < 3 && count < kWideChildren; ++axis) {
      const std::size_t row = sizeof(Node::low) / 3;
      for (const std::size_t side : {std::size_t{0}, sizeof(Node::low)}) {
        const std::size_t last = side + axis * row + row - 1;  // child 7
        EXPECT_TRUE(is_found_at(bytes, SectionKind::kNodes, n * sizeof(Node) + last, 0x80)) << n;
        ++unused;
      }
    }
  }
  EXPECT_GT(unused, 0u);
}

TEST(ReservedBits, OfWideNodesAreFound) {
  expect_found_in_wide_nodes<Wide8Node>(CodecId::kWide8);
  expect_found_in_wide_nodes<Wide4Node>(CodecId::kWide4);
  const FileBytes bytes = test::cook_bytes(test::soup(100, 2), CodecId::kWide8);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_TRUE(is_found_at(bytes, SectionKind::kNodes, offsetof(Wide8Node, reserved) + i, 1));
  }
}

TEST(ReservedBits, OfPlainNodesAreFound) {
  // A strip whose boxes leave room beside them: some nodes have one child.
  const FileBytes bytes = test::cook_bytes(test::torus(24, 12), CodecId::kPlainF32);
  const SectionEntry entry = test::entry_of(bytes, SectionKind::kNodes);
  std::size_t absent = 0;
  for (std::size_t n = 0; n < entry.size / sizeof(PlainNodeF32); ++n) {
    const auto node = load<PlainNodeF32>(bytes.data() + entry.offset, n);
    for (std::size_t side = 0; side < 2; ++side) {
      if (node.kind(side) != PlainChild::kNone) continue;
      ++absent;
      const std::uint64_t at = n * sizeof(PlainNodeF32) + offsetof(PlainNodeF32, cut) + 4 * side;
      EXPECT_TRUE(is_found_at(bytes, SectionKind::kNodes, at, 1)) << n;
    }
  }
  EXPECT_GT(absent, 0u);
}

TEST(ReservedBits, BehindPackedArraysAreFound) {
  for (const CodecId codec :
       {CodecId::kPackedF32, CodecId::kPackedF16, CodecId::kPackedF64, CodecId::kDedup}) {
    const FileBytes bytes = test::cook_bytes(test::torus(24, 12), codec);
    const SectionEntry entry = test::entry_of(bytes, SectionKind::kNodes);
    const auto header = load<PackedHeader>(bytes.data() + entry.offset);
    const PackedPlaces places(header);
    for (std::size_t kind = 0; kind < kNodeKinds; ++kind) {
      const PackedLayout layout(static_cast<NodeKind>(kind), header);
      const std::uint64_t end =
          places.array_at[kind] * 8 + std::uint64_t{header.node_count[kind]} * layout.bits;
      const std::uint64_t next =
          kind + 1 < kNodeKinds ? places.array_at[kind + 1] * 8 : entry.size * 8;
      for (std::uint64_t bit = end; bit < next; ++bit) {
        EXPECT_TRUE(is_found_at(bytes, SectionKind::kNodes, bit / 8, 1u << (bit % 8)))
            << codec_name(codec) << ", bit " << bit;
      }
    }
  }
}

TEST(ReservedBits, OfClustersAreFound) {
  cooker::CookOptions options;
  options.geometry = GeometryId::kGrid;
  options.grid.bits = 16;
  const FileBytes bytes = test::cook_bytes(test::torus(24, 12), CodecId::kWide8, options);
  const std::uint64_t clusters =
      test::entry_of(bytes, SectionKind::kCorners).size / sizeof(ClusterRecord);
  ASSERT_GT(clusters, 2u);
  for (std::uint64_t n = 0; n < clusters; ++n) {
    const std::uint64_t at = n * sizeof(ClusterRecord) + offsetof(ClusterRecord, reserved);
    EXPECT_TRUE(is_found_at(bytes, SectionKind::kCorners, at, 1));
  }
  const std::uint64_t size = test::entry_of(bytes, SectionKind::kVertices).size;
  for (std::uint64_t at = size - kClusterPadding; at < size; ++at) {
    EXPECT_TRUE(is_found_at(bytes, SectionKind::kVertices, at, 1)) << at;
  }
}

}  // namespace
}  // namespace boxtree
