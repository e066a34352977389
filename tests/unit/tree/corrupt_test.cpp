// SPDX-License-Identifier: MIT
// Nodes and leaves that contradict themselves: whoever comes to them is told, by every query.
#include <cmath>
#include <cstring>
#include <deque>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "cooker/proof/proof.h"
#include "format/bits.h"
#include "format/cluster_leaf.h"
#include "format/codec_wide.h"
#include "format/container.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/tree_queries.h"

namespace boxtree {
namespace {

using Section = std::span<std::byte>;

template <class Record>
void edit(Section bytes, std::size_t index, const std::function<void(Record&)>& change) {
  auto record = load<Record>(bytes.data(), index);
  change(record);
  std::memcpy(bytes.data() + index * sizeof(Record), &record, sizeof(record));
}

// In section vertices of a store of clusters.
std::byte* first_cluster(Section vertices) {
  return vertices.data() + load<std::uint32_t>(vertices.data()) * kClusterUnit;
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
  // Between 64 and 128, where the numbers of floats have the same exponent.
  cooker::SourceMesh mesh = test::soup(300, 3);
  float largest = 0;
  for (const float x : mesh.positions.f32) largest = std::max(largest, std::abs(x));
  for (float& x : mesh.positions.f32) x = 96 + 31 * x / largest;
  cooker::CookOptions options;
  options.geometry = corruption.geometry;
  options.grid.bits = 12;
  const test::CookedTree whole = test::cook_tree(mesh, corruption.codec, options);
  std::vector<std::byte> bytes = whole.bytes;
  corruption.change(test::section_of(bytes, corruption.section));
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
        {name, codec, GeometryId::kArrays, SectionKind::kCorners, Errc::kVertexOutOfRange,
         [](Section corners) { std::fill(corners.begin(), corners.end(), std::byte{0xfe}); }});
  }
  all.push_back({"wide8_clusters", CodecId::kWide8, GeometryId::kExact, SectionKind::kVertices,
                 Errc::kVertexOutOfRange, [](Section vertices) {
                   std::fill_n(vertices.begin(), sizeof(std::uint32_t), std::byte{0xfe});
                 }});
  for (const auto& [name, codec] : {std::pair("plain_f32_positions", CodecId::kPlainF32),
                                    {"wide8_positions", CodecId::kWide8},
                                    {"wide4_positions", CodecId::kWide4}}) {
    all.push_back({name, codec, GeometryId::kArrays, SectionKind::kVertices, Errc::kVertexNotFinite,
                   [](Section positions) {
                     std::fill(positions.begin(), positions.end(), std::byte{0xff});
                   }});
  }
  // Numbers that are no float's.
  for (const auto& [name, codec] :
       {std::pair("wide8_origin", CodecId::kWide8), {"wide4_origin", CodecId::kWide4}}) {
    all.push_back(
        {name, codec, GeometryId::kExact, SectionKind::kVertices, Errc::kVertexNotFinite,
         [](Section vertices) {
           std::byte* const cluster = first_cluster(vertices);
           const std::array<std::int32_t, 3> origin = {0x7f800001, 0x7f800001, 0x7f800001};
           ClusterHeader header{};
           std::memcpy(&header, cluster, sizeof(header));
           header.trailing = {};
           std::memcpy(cluster, &header, sizeof(header));
           std::memcpy(cluster + sizeof(header), origin.data(), sizeof(origin));
         }});
  }
  for (const GeometryId geometry : {GeometryId::kGrid, GeometryId::kExact}) {
    for (const CodecId codec : {CodecId::kPlainF32, CodecId::kWide8, CodecId::kWide4}) {
      if (geometry == GeometryId::kExact && !is_wide(codec)) continue;
      for (const auto& [name, at] : {std::pair("trailing", offsetof(ClusterHeader, trailing)),
                                     {"base_shift", offsetof(ClusterHeader, base_shift)},
                                     {"width", offsetof(ClusterHeader, width)},
                                     {"width_of_z", offsetof(ClusterHeader, width) + 2},
                                     {"group_size", offsetof(ClusterHeader, group_size)},
                                     {"vertex_count", offsetof(ClusterHeader, vertex_count) + 1},
                                     {"leaves_at", offsetof(ClusterHeader, leaves_at)},
                                     {"start_bits", offsetof(ClusterHeader, start_bits)},
                                     {"first_bits", offsetof(ClusterHeader, first_bits)},
                                     {"old_bits", offsetof(ClusterHeader, old_bits)}}) {
        static std::deque<std::string> names;  // that stay in their places
        names.push_back(std::string(codec_name(codec)) + '_' +
                        std::string(geometry_name(geometry)) + '_' + name);
        std::replace(names.back().begin(), names.back().end(), '-', '_');
        all.push_back(
            {names.back().c_str(), codec, geometry, SectionKind::kVertices, Errc::kVertexOutOfRange,
             [at = at](Section vertices) { first_cluster(vertices)[at] = std::byte{0xff}; }});
      }
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(All, Corrupt, testing::ValuesIn(corruptions()),
                         [](const auto& test) { return std::string(test.param.name); });

// Two triangles that share nothing. Any change of a bit of their leaf is refused or gives other
// corners: no two codes of a step mean the same. Only the width of old references means nothing
// where there are none, and is a finding of verify.
TEST(ClusterLeaf, EveryBitMatters) {
  cooker::SourceMesh mesh = test::soup(2, 5);
  cooker::CookOptions options;
  options.geometry = GeometryId::kGrid;
  options.grid.bits = 12;
  const test::CookedTree whole = test::cook_tree(mesh, CodecId::kPlainF32, options);
  std::vector<std::byte> bytes = whole.bytes;
  const Section clusters = test::section_of(bytes, SectionKind::kVertices);
  ClusterLeaf leaf;
  ClusterLeafFields place;
  FoundCluster found;
  ASSERT_TRUE(
      decode_cluster_leaf(BoundTree::of(whole.tree).leaves().clusters(), 0, found, leaf, &place));
  const std::size_t begin = place.begin;
  const std::size_t end = place.end;
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
  for (std::size_t bit = begin; bit < end; ++bit) {
    clusters[bit / 8] ^= std::byte{1} << (bit % 8);
    test::repair_checksums(bytes);
    const Result<File> file = File::open(Bytes(bytes));
    ASSERT_TRUE(file.ok());
    const bool is_same = corners(*Tree::bind(*file)) == expected;
    without_effect += is_same && cooker::verify_file(*file).empty() ? 1u : 0u;
    clusters[bit / 8] ^= std::byte{1} << (bit % 8);
  }
  EXPECT_EQ(without_effect, 0u);
}

}  // namespace
}  // namespace boxtree
