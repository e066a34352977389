// SPDX-License-Identifier: MIT
// Bits that mean nothing and have to be zero: verify finds each of them in every codec and store,
// and none in files as they are written.
#include <algorithm>
#include <cstring>
#include <string_view>

#include <gtest/gtest.h>

#include "cooker/proof/proof.h"
#include "format/cluster.h"
#include "format/cluster_leaf.h"
#include "format/codec_packed.h"
#include "format/codec_plain.h"
#include "format/codec_wide.h"
#include "format/container.h"
#include "format/face_ids.h"
#include "format/limits.h"
#include "format/tree_record.h"
#include "runtime/file/open_file.h"
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
  const FileBytes bytes = test::cook_bytes(test::torus(48, 24), CodecId::kWide8, options);
  const SectionEntry vertices = test::entry_of(bytes, SectionKind::kVertices);
  const std::uint64_t size = vertices.size;
  for (std::uint64_t at = size - kClusterPadding; at < size; ++at) {
    EXPECT_TRUE(is_found_at(bytes, SectionKind::kVertices, at, 1)) << at;
  }
}

// A mesh whose last group of face ids is shorter than the others.
cooker::SourceMesh mesh_of_several_groups() {
  cooker::SourceMesh mesh = test::torus(48, 24);
  std::reverse(mesh.faces.begin(), mesh.faces.end());
  return mesh;
}

TEST(ReservedBits, OfFaceIdsAreFound) {
  const FileBytes bytes = test::cook_bytes(mesh_of_several_groups(), CodecId::kWide8);
  const SectionEntry section = test::entry_of(bytes, SectionKind::kFaceIds);
  const auto record =
      load<TreeRecord>(bytes.data() + test::entry_of(bytes, SectionKind::kTrees).offset);
  const std::byte* const ids = bytes.data() + section.offset;
  const std::uint32_t groups = id_groups_of(record.face_count);
  ASSERT_GT(groups, 1u);
  ASSERT_NE(id_blocks_of(record.face_count) % kIdGroupBlocks, 0u);
  std::size_t gaps = 0;
  for (std::uint32_t g = 0; g < groups; ++g) {
    const std::uint32_t last = std::min((g + 1) * kIdGroupFaces, record.face_count) - 1;
    const std::byte* const group = ids + g * sizeof(FaceIdGroup);
    const auto begin = load<std::uint32_t>(group + offsetof(FaceIdGroup, begin));
    const FaceIdBlock block = FaceIdBlock::of(load<std::uint32_t>(
        group + offsetof(FaceIdGroup, block), last / kIdBlockFaces % kIdGroupBlocks));
    const std::uint64_t end =
        begin * kIdUnit * 8 + block.middle + (last % kIdBlockFaces + 1) * block.width();
    const std::uint64_t next =
        g + 1 < groups
            ? load<std::uint32_t>(group + sizeof(FaceIdGroup) + offsetof(FaceIdGroup, begin)) *
                  kIdUnit * 8
            : section.size * 8;
    for (std::uint64_t bit = end; bit < next; ++bit) {
      ++gaps;
      EXPECT_TRUE(is_found_at(bytes, SectionKind::kFaceIds, bit / 8, 1u << (bit % 8))) << bit;
    }
  }
  EXPECT_GT(gaps, kBitPadding * 8);
}

// What no reader can tell from valid ids while it answers a query.
TEST(FaceIds, ThatLieWhereTheyMustNotAreFound) {
  const FileBytes valid = test::cook_bytes(mesh_of_several_groups(), CodecId::kWide8);
  const SectionEntry section = test::entry_of(valid, SectionKind::kFaceIds);
  const auto is_found_after = [&](auto change) {
    FileBytes bytes = valid;
    auto group = load<FaceIdGroup>(bytes.data() + section.offset, 1);
    FaceIdBlock block = FaceIdBlock::of(group.block[3]);
    change(group, block);
    group.block[3] = block.word();
    std::memcpy(bytes.data() + section.offset + sizeof(group), &group, sizeof(group));
    test::repair_checksums(bytes);
    const cooker::Findings findings = cooker::verify_file(test::require(File::open(Bytes(bytes))));
    return std::any_of(findings.begin(), findings.end(),
                       [](const Error& finding) { return finding.code == Errc::kFaceOutOfRange; });
  };
  using Group = FaceIdGroup;
  using Block = FaceIdBlock;
  EXPECT_FALSE(is_found_after([](Group&, Block&) {}));
  EXPECT_TRUE(is_found_after([](Group& group, Block&) { group.begin += 1; }));
  EXPECT_TRUE(is_found_after([](Group& group, Block&) { group.begin = 0xffffffffu; }));
  EXPECT_TRUE(is_found_after([](Group& group, Block&) { group.base = kMaxFaces; }));
  EXPECT_TRUE(is_found_after([](Group&, Block& block) { block.middle -= 1; }));
  EXPECT_TRUE(is_found_after([](Group&, Block& block) { block.middle = 0xffff; }));
  EXPECT_TRUE(is_found_after([](Group&, Block& block) { block.middle = 0; }));
  EXPECT_TRUE(is_found_after([](Group&, Block& block) { block.start_bits += 1; }));
  EXPECT_TRUE(is_found_after([](Group&, Block& block) { block.offset_bits += 1; }));
  EXPECT_TRUE(is_found_after([](Group&, Block& block) { block.grain = 7; }));
}

TEST(FaceIds, OfTooFewBytesAreRefused) {
  cooker::EncodedTree tree =
      test::require(cooker::cook_as(mesh_of_several_groups(), CodecId::kWide8));
  const auto bound_with = [&tree](std::size_t size) {
    tree.geometry.face_ids.resize(size);
    return cooker::bind_encoded(tree).code();
  };
  const std::size_t least = least_id_bytes(tree.face_count);
  EXPECT_EQ(bound_with(least), Errc::kOk);
  EXPECT_EQ(bound_with(least - 1), Errc::kSectionSize);
  EXPECT_EQ(bound_with(1), Errc::kSectionSize);
  EXPECT_EQ(bound_with(0), Errc::kOk);  // there are none
}

// Found by the second reader: a child that is not there has kind 0 and cut 0.
TEST(ReservedBits, OfMissingChildrenInPackedNodesAreFound) {
  for (const CodecId codec :
       {CodecId::kPackedF32, CodecId::kPackedF16, CodecId::kPackedF64, CodecId::kDedup}) {
    const FileBytes bytes = test::cook_bytes(test::torus(24, 12), codec);
    const SectionEntry entry = test::entry_of(bytes, SectionKind::kNodes);
    const std::byte* const nodes = bytes.data() + entry.offset;
    const auto header = load<PackedHeader>(nodes);
    const auto kind = static_cast<std::size_t>(NodeKind::kNoLeaves);
    const PackedLayout layout(NodeKind::kNoLeaves, header);
    std::size_t missing = 0;
    for (std::uint64_t n = 0; n < header.node_count[kind]; ++n) {
      const std::uint64_t node = PackedPlaces(header).array_at[kind] * 8 + n * layout.bits;
      for (std::size_t side = 0; side < 2; ++side) {
        const std::uint32_t width = layout.number_bits[side];
        if (read_bits(nodes, node + layout.number_at[side], width) != low_bits(width)) continue;
        ++missing;
        const auto is_found_in = [&](std::uint64_t bit) {
          return is_found_at(bytes, SectionKind::kNodes, bit / 8, 1u << (bit % 8));
        };
        EXPECT_TRUE(is_found_in(node + layout.kind_at[side])) << codec_name(codec) << ' ' << n;
        EXPECT_TRUE(is_found_in(node + layout.kind_at[side] + 1)) << codec_name(codec) << ' ' << n;
        // The last bit of a cut, or another cut of the table.
        EXPECT_TRUE(is_found_in(node + layout.cut_at[side])) << codec_name(codec) << ' ' << n;
      }
    }
    EXPECT_GT(missing, 0u) << codec_name(codec);
  }
}

// Found by the second reader: leaves begin in whole bytes and end in any bit. So do tables, widths
// of groups and the vertices of a group.
TEST(ReservedBits, BetweenPartsOfClustersAreFound) {
  for (const GeometryId geometry : {GeometryId::kGrid, GeometryId::kExact}) {
    cooker::CookOptions options;
    options.geometry = geometry;
    options.grid.bits = 16;
    std::size_t gaps = 0, gaps_of_groups = 0;
    for (const cooker::SourceMesh& mesh : {test::torus(24, 12), test::city(4, 1)}) {
      const test::CookedTree cooked = test::cook_tree(mesh, CodecId::kWide8, options);
      const ClusterView& clusters = BoundTree::of(cooked.tree).leaves().clusters();
      const auto expect_found = [&](std::uint64_t from, std::uint64_t to, std::uint32_t where) {
        for (std::uint64_t bit = from; bit < to; ++bit) {
          EXPECT_TRUE(is_found_at(cooked.bytes, SectionKind::kVertices, bit / 8, 1u << (bit % 8)))
              << where;
        }
        return to - from;
      };
      std::uint64_t end = 0;
      FoundCluster found;
      for (std::uint32_t leaf = 0; leaf < leaves_of(clusters.face_count); ++leaf) {
        ClusterLeaf decoded;
        ClusterLeafFields place;
        ASSERT_TRUE(decode_cluster_leaf(clusters, leaf, found, decoded, &place));
        if (leaf % kClusterLeaves != 0) gaps += expect_found(end, place.begin, leaf);
        end = place.end;
      }
      for (std::uint32_t n = 0; n < clusters_of(clusters.face_count); ++n) {
        Cluster cluster;
        ClusterGroups groups;
        ASSERT_TRUE(find_cluster(clusters, n, cluster) && find_groups(cluster, groups));
        const auto start = static_cast<std::uint64_t>(cluster.bytes - clusters.bytes.data()) * 8;
        const std::uint32_t leaves =
            std::min(kClusterLeaves, static_cast<std::uint32_t>(leaves_of(clusters.face_count)) -
                                         n * kClusterLeaves);
        gaps_of_groups += expect_found(start + cluster.table + leaves * cluster.entry_bits,
                                       start + 8 * cluster.bases_at, n);
        for (std::uint32_t k = 0; k < 3; ++k) {
          const std::uint64_t widths = start + 8 * (cluster.wider_at + k * cluster.wider_bytes());
          gaps_of_groups += expect_found(widths + ClusterHeader::kWiderBits * cluster.groups,
                                         widths + 8 * cluster.wider_bytes(), n);
        }
        for (std::uint32_t g = 0; g < cluster.groups; ++g) {
          const std::uint32_t size =
              g + 1 == cluster.groups ? cluster.last_group_size() : cluster.header().group_size();
          const std::uint64_t after =
              start + 8 * (cluster.vertices_at + groups.start[g]) + size * groups.stride[g];
          gaps_of_groups += expect_found(after, align_up(after, 8), g);
        }
      }
    }
    EXPECT_GT(gaps, 0u);
    EXPECT_GT(gaps_of_groups, 0u);
  }
}

bool say(const cooker::Findings& findings, std::string_view text) {
  return std::any_of(findings.begin(), findings.end(), [&](const Error& finding) {
    return finding.detail.find(text) != std::string::npos;
  });
}

// What verify finds after `change` was added to a byte of the header of the first cluster.
cooker::Findings findings_after(const test::CookedTree& cooked, std::size_t field, int change) {
  const std::uint32_t face_count = BoundTree::of(cooked.tree).leaves().clusters().face_count;
  FileBytes bytes = cooked.bytes;
  std::byte& low = bytes[test::entry_of(bytes, SectionKind::kVertices).offset +
                         cluster_table_bytes(face_count) + field];
  low = static_cast<std::byte>(std::to_integer<int>(low) + change);
  test::repair_checksums(bytes);
  return cooker::verify_file(test::require(File::open(Bytes(bytes))));
}

// Readers decode other vertices of the cluster.
TEST(ReservedBits, VerticesThatAreNotUsedInOrderAreFound) {
  const test::CookedTree cooked = test::cook_tree(test::torus(24, 12), CodecId::kWide8);
  // That of leaf 1 is one more.
  EXPECT_TRUE(say(
      findings_after(cooked, offsetof(ClusterHeader, first_slope), 1 << ClusterHeader::kSlopeBits),
      "of its cluster is the first that it uses first, expected"));
}

TEST(ReservedBits, AVertexThatNoLeafUsesIsFound) {
  // One place, so that vertices take no bits.
  cooker::SourceMesh mesh = test::soup(1, 1);
  std::fill(mesh.positions.f32.begin(), mesh.positions.f32.end(), 1.0f);
  const test::CookedTree cooked = test::cook_tree(mesh, CodecId::kWide8);
  EXPECT_TRUE(findings_after(cooked, offsetof(ClusterHeader, vertex_count), 0).empty());
  EXPECT_TRUE(say(findings_after(cooked, offsetof(ClusterHeader, vertex_count), 1),
                  "cluster 0 has 2 vertices, of which its leaves use 1"));
}

// Found by the second reader: bytes behind the last cluster that are no one's.
TEST(ReservedBits, MoreBytesThanThePaddingAreFound) {
  cooker::CookOptions options;
  options.geometry = GeometryId::kGrid;
  options.grid.bits = 16;
  std::size_t tried = 0;
  for (const std::uint32_t faces : {10u, 20u, 30u, 40u}) {
    FileBytes bytes = test::cook_bytes(test::soup(faces, 1), CodecId::kWide8, options);
    const SectionEntry vertices = test::entry_of(bytes, SectionKind::kVertices);
    // There is room before the next section.
    if (align_up(vertices.size, kSmallAlignment) - vertices.size < kClusterUnit) continue;
    ++tried;
    test::edit_entry(bytes, SectionKind::kVertices,
                     [](SectionEntry& entry) { entry.size += kClusterUnit; });
    EXPECT_TRUE(is_found(bytes));
  }
  EXPECT_GT(tried, 0u);
}

// Found by the second reader.
TEST(Names, ThatAreNoUtf8AreFoundAndNotWritten) {
  cooker::SourceMesh mesh = test::soup(20, 1);
  mesh.name = "t\xc3\xbcr\xff\xed\xa0\x80";
  FileBytes bytes = test::cook_bytes(mesh, CodecId::kWide8);
  const File file = test::require(File::open(Bytes(bytes)));
  EXPECT_EQ(file.tree_name(0), "t\xc3\xbcr\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd");
  EXPECT_TRUE(cooker::verify_file(file).empty());
  const SectionEntry names = test::entry_of(bytes, SectionKind::kNames);
  bytes[names.offset] = std::byte{0xff};
  test::repair_checksums(bytes);
  const cooker::Findings findings = cooker::verify_file(test::require(File::open(Bytes(bytes))));
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].code, Errc::kRecordInvalid);
  EXPECT_EQ(findings[0].detail, "tree 0: its name is no UTF-8");
  test::edit_records<TreeRecord>(
      bytes, SectionKind::kTrees,
      [](TreeRecord& record, std::uint32_t, std::uint32_t) { record.name_bytes = 1000; });
  EXPECT_EQ(cooker::verify_file(test::require(File::open(Bytes(bytes))))[0].detail,
            "tree 0: its name lies outside section names");
}

}  // namespace
}  // namespace boxtree
