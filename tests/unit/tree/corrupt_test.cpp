// SPDX-License-Identifier: MIT
// Nodes and leaves that contradict themselves: whoever comes to them is told, by every query.
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "format/bits.h"
#include "format/codec_wide.h"
#include "format/container.h"
#include "format/grid.h"
#include "runtime/file/open_file.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/tree_queries.h"

namespace boxtree {
namespace {

using Section = std::span<std::byte>;

Section section_of(std::vector<std::byte>& bytes, SectionKind kind) {
  const Result<File> file = File::open(Bytes(bytes));
  for (const SectionEntry& entry : OpenFile::of(*file).container().sections) {
    if (entry.kind == static_cast<std::uint32_t>(kind)) {
      return Section(bytes).subspan(entry.offset, entry.size);
    }
  }
  throw std::runtime_error("no such section");
}

template <class Record>
void edit(Section bytes, std::size_t index, const std::function<void(Record&)>& change) {
  auto record = load<Record>(bytes.data(), index);
  change(record);
  std::memcpy(bytes.data() + index * sizeof(Record), &record, sizeof(record));
}

struct Corruption {
  const char* name;
  CodecId codec;
  GeometryId geometry;
  SectionKind section;
  Errc expected;
  std::function<void(Section)> change;
};

void PrintTo(const Corruption& corruption, std::ostream* out) {
  *out << corruption.name;
}

// What each query says of a tree that is broken wherever they look: each looks at a box, a ray or a
// ball around a corner of a face, so that leaves are read and not taken whole.
std::vector<std::pair<std::string, Errc>> answers(const Tree& broken, const Tree& whole,
                                                  const Eigen::Vector3d& corner) {
  const Eigen::Vector3d near = Eigen::Vector3d::Constant(1e-3);
  test::QuerySet queries;
  queries.ray = {corner - Eigen::Vector3d(0, 0, 50), {0, 0, 1}};
  queries.box = {corner - near, corner + near};
  queries.point = corner;
  queries.radius = 1e-3;
  queries.far.translation() = Eigen::Vector3d(100, 0, 0);
  queries.node_budget = kUnlimitedNodes;
  std::vector<std::pair<std::string, Errc>> codes;
  for (const test::TreeQuery& query : test::tree_queries(queries)) {
    codes.emplace_back(query.name, query.run_query(broken, whole, {}).error);
    if (!query.is_of_pairs) continue;
    codes.emplace_back(std::string(query.name) + " as second",
                       query.run_query(whole, broken, {}).error);
  }
  return codes;
}

class Corrupt : public testing::TestWithParam<Corruption> {};

TEST_P(Corrupt, EveryQuerySaysSo) {
  const Corruption& corruption = GetParam();
  const cooker::SourceMesh mesh = test::soup(300, 3);
  cooker::CookOptions options;
  options.geometry = corruption.geometry;
  options.grid.bits = 12;
  const test::CookedTree whole = test::cook_tree(mesh, corruption.codec, options);
  std::vector<std::byte> bytes = whole.bytes;
  corruption.change(section_of(bytes, corruption.section));
  test::repair_checksums(bytes);
  const Result<File> file = File::open(Bytes(bytes));
  ASSERT_TRUE(file.ok()) << file.error().message();
  const Result<Tree> broken = Tree::bind(*file);
  ASSERT_TRUE(broken.ok()) << broken.error().message();
  const Eigen::Vector3d stored = test::all_triangles(whole.tree).front().corner[0];
  Box<double> place;
  for (std::size_t k = 0; k < 3; ++k) {
    place.low[k] = place.high[k] = stored[static_cast<Eigen::Index>(k)];
  }
  const Eigen::Vector3d corner = BoundTree::of(whole.tree).to_object(place).center();
  for (const auto& [query, code] : answers(*broken, whole.tree, corner)) {
    EXPECT_EQ(code, corruption.expected) << query;
  }
  if (corruption.expected == Errc::kNodeCorrupt) {
    NodeChildren children;
    children.count = 5;
    EXPECT_EQ(BoundTree::of(*broken).expand(BoundTree::of(*broken).root(), children),
              NodeState::kCorrupt);
    EXPECT_EQ(children.count, 0u);
  }
}

// Changes the links of the root of a wide tree.
void edit_links(Section nodes, CodecId codec, const std::function<void(WideLinks&)>& change) {
  if (codec == CodecId::kWide8) {
    edit<Wide8Node>(nodes, 0, [&](Wide8Node& node) {
      WideLinks links = links_of(node);
      change(links);
      node.first_node = links.first_node;
      node.first_leaf = links.first_leaf;
      node.inner_mask = static_cast<std::uint8_t>(links.inner_mask);
      node.child_count = static_cast<std::uint8_t>(links.child_count);
    });
  } else {
    edit<Wide4Node>(nodes, 0, [&](Wide4Node& node) {
      WideLinks links = links_of(node);
      change(links);
      node.links = std::uint64_t{links.first_node} | std::uint64_t{links.first_leaf} << 26 |
                   std::uint64_t{links.inner_mask} << 53 |
                   std::uint64_t{links.child_count - 1} << 61;
    });
  }
}

std::vector<Corruption> corruptions() {
  std::vector<Corruption> all;
  const auto add_links = [&all](const char* name, CodecId codec,
                                const std::function<void(WideLinks&)>& change) {
    all.push_back({name, codec, GeometryId::kExact, SectionKind::kNodes, Errc::kNodeCorrupt,
                   [=](Section nodes) { edit_links(nodes, codec, change); }});
  };
  const auto own = [](WideLinks& links) { links.first_node = 0; };
  const auto outside = [](WideLinks& links) { links.first_node = 60; };
  const auto no_face = [](WideLinks& links) {
    links.inner_mask &= ~1u;
    links.first_leaf = 38;  // 300 faces are 38 leaves
  };
  const auto more = [](WideLinks& links) {
    links.inner_mask |= 0x80u;
    links.child_count = 7;
  };
  add_links("wide8_own_child", CodecId::kWide8, own);
  add_links("wide4_own_child", CodecId::kWide4, own);
  add_links("wide8_outside", CodecId::kWide8, outside);
  add_links("wide4_outside", CodecId::kWide4, outside);
  add_links("wide8_leaf_without_faces", CodecId::kWide8, no_face);
  add_links("wide4_leaf_without_faces", CodecId::kWide4, no_face);
  add_links("wide8_inner_child_that_is_not_there", CodecId::kWide8, more);
  add_links("wide4_inner_child_that_is_not_there", CodecId::kWide4, more);
  add_links("wide8_no_children", CodecId::kWide8, [](WideLinks& links) { links.child_count = 0; });
  add_links("wide8_nine_children", CodecId::kWide8,
            [](WideLinks& links) { links.child_count = 9; });

  for (const auto& [name, codec] : {std::pair("plain_f32_vertices", CodecId::kPlainF32),
                                    {"wide8_vertices", CodecId::kWide8},
                                    {"dedup_vertices", CodecId::kDedup}}) {
    all.push_back(
        {name, codec, GeometryId::kExact, SectionKind::kCorners, Errc::kVertexOutOfRange,
         [](Section corners) { std::fill(corners.begin(), corners.end(), std::byte{0xfe}); }});
  }
  for (const auto& [name, codec] : {std::pair("plain_f32_positions", CodecId::kPlainF32),
                                    {"wide8_positions", CodecId::kWide8},
                                    {"wide4_positions", CodecId::kWide4}}) {
    all.push_back({name, codec, GeometryId::kExact, SectionKind::kVertices, Errc::kVertexNotFinite,
                   [](Section positions) {
                     std::fill(positions.begin(), positions.end(), std::byte{0xff});
                   }});
  }
  for (const auto& [name, codec] : {std::pair("plain_f32_grid", CodecId::kPlainF32),
                                    {"wide8_grid", CodecId::kWide8},
                                    {"wide4_grid", CodecId::kWide4}}) {
    all.push_back({name, codec, GeometryId::kGrid, SectionKind::kCorners, Errc::kVertexOutOfRange,
                   [](Section clusters) {
                     for (std::size_t i = 0; i < clusters.size() / sizeof(ClusterRecord); ++i) {
                       edit<ClusterRecord>(clusters, i,
                                           [](ClusterRecord& c) { c.vertex_count = 1; });
                     }
                   }});
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(All, Corrupt, testing::ValuesIn(corruptions()),
                         [](const auto& test) { return std::string(test.param.name); });

// Two triangles that share nothing. Any change of a bit of their leaf is refused or gives other
// corners, but for what fills up its last byte: no two codes of a step mean the same.
TEST(GridLeaf, EveryBitMatters) {
  cooker::SourceMesh mesh = test::soup(2, 5);
  cooker::CookOptions options;
  options.geometry = GeometryId::kGrid;
  options.grid.bits = 12;
  const test::CookedTree whole = test::cook_tree(mesh, CodecId::kPlainF32, options);
  std::vector<std::byte> bytes = whole.bytes;
  const auto cluster = load<ClusterRecord>(section_of(bytes, SectionKind::kCorners).data());
  const Section clusters = section_of(bytes, SectionKind::kVertices);
  // Fields of leaf_bits for one leaf and one more, then the leaf.
  const std::size_t begin = (std::size_t{2} * cluster.leaf_bits + 7) / 8;
  const std::size_t end =
      begin + cluster.leaf_bytes +
      read_bits(clusters.data(), std::uint64_t{cluster.leaf_bits}, cluster.leaf_bits);
  ASSERT_LT(begin, end);
  const auto corners = [](const Tree& tree) {
    std::vector<double> all;
    TriangleBatch batch;
    if (BoundTree::of(tree).leaves().read(0, 2, batch) != Errc::kOk) return all;
    for (std::uint32_t i = 0; i < batch.count; ++i) {
      for (const Eigen::Vector3d& corner : batch.triangle(i).corner) {
        all.insert(all.end(), corner.data(), corner.data() + 3);
      }
    }
    return all;
  };
  const std::vector<double> expected = corners(whole.tree);
  ASSERT_EQ(expected.size(), 18u);
  std::size_t without_effect = 0;
  for (std::size_t bit = 8 * begin; bit < 8 * end; ++bit) {
    clusters[bit / 8] ^= std::byte{1} << (bit % 8);
    test::repair_checksums(bytes);
    const Result<File> file = File::open(Bytes(bytes));
    ASSERT_TRUE(file.ok());
    without_effect += corners(*Tree::bind(*file)) == expected ? 1u : 0u;
    clusters[bit / 8] ^= std::byte{1} << (bit % 8);
  }
  EXPECT_LT(without_effect, 8u);
}

}  // namespace
}  // namespace boxtree
