// SPDX-License-Identifier: MIT
// Geometry exact: every bit of every position of the source comes back, face by face and corner by
// corner, whatever the numbers; and leaves that name vertices of many others.
#include "format/cluster.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <random>
#include <span>

#include <gtest/gtest.h>

#include "cooker/proof/proof.h"
#include "cooker/write/file_writer.h"
#include "format/cluster_leaf.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"

namespace boxtree {
namespace {

using cooker::kNoCorner;
using cooker::SourceMesh;

using Bits = std::array<std::uint64_t, 3>;

Bits bits_of(const std::array<double, 3>& position) {
  return {std::bit_cast<std::uint64_t>(position[0]), std::bit_cast<std::uint64_t>(position[1]),
          std::bit_cast<std::uint64_t>(position[2])};
}

// Corners of the faces, as doubles, by source number.
std::map<std::uint32_t, std::vector<Bits>> decoded(const Tree& tree) {
  const ClusterView& clusters = BoundTree::of(tree).leaves().clusters();
  std::map<std::uint32_t, std::vector<Bits>> faces;
  FoundCluster found;
  ClusterLeaf leaf;
  for (std::uint32_t i = 0; i < leaves_of(clusters.face_count); ++i) {
    if (!decode_cluster_leaf(clusters, i, found, leaf)) {
      ADD_FAILURE() << "leaf " << i;
      return faces;
    }
    for (std::uint32_t f = 0; f < leaf.face_count; ++f) {
      std::vector<Bits>& corners = faces[BoundTree::of(tree).face_id(i * kLeafFaces + f)];
      for (const std::uint8_t corner : leaf.corner[f]) {
        if (corner != ClusterLeaf::kNoCorner) corners.push_back(bits_of(leaf.position[corner]));
      }
    }
  }
  return faces;
}

std::map<std::uint32_t, std::vector<Bits>> source(const SourceMesh& mesh) {
  std::map<std::uint32_t, std::vector<Bits>> faces;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    std::vector<Bits>& corners = faces[mesh.face_id(f)];
    for (const std::uint32_t corner : mesh.faces[f].corner) {
      if (corner == kNoCorner) continue;
      const Eigen::Vector3d p = mesh.positions[corner];
      corners.push_back(bits_of({p[0], p[1], p[2]}));
    }
  }
  return faces;
}

// The same mesh with positions of f64 that f32 does not have.
SourceMesh in_f64(const SourceMesh& mesh) {
  SourceMesh wide = mesh;
  wide.positions = {cooker::Precision::kF64, {}, {}};
  for (const float x : mesh.positions.f32) wide.positions.f64.push_back(double{x} * 1.1);
  return wide;
}

class ExactStore : public testing::TestWithParam<CodecId> {};

TEST_P(ExactStore, HoldsEveryBitOfEveryPosition) {
  for (const SourceMesh& mesh : test::all_kinds()) {
    for (const SourceMesh& each : {mesh, in_f64(mesh)}) {
      const test::CookedTree cooked = test::cook_tree(each, GetParam());
      ASSERT_EQ(BoundTree::of(cooked.tree).geometry(), GeometryId::kExact);
      EXPECT_EQ(decoded(cooked.tree), source(each)) << mesh.name;
    }
  }
}

// Any finite float: both zeros, subnormals, the largest, in one cluster.
TEST_P(ExactStore, HoldsFloatsOfEveryExponent) {
  std::mt19937_64 random(7);
  SourceMesh mesh = test::soup(700, 4);
  SourceMesh wide = in_f64(mesh);
  for (float& x : mesh.positions.f32) {
    do x = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    while (!std::isfinite(x) || std::abs(x) > 0x1p100f);
  }
  mesh.positions.f32[0] = -0.0f;
  mesh.positions.f32[1] = 0.0f;
  mesh.positions.f32[2] = std::numeric_limits<float>::denorm_min();
  mesh.positions.f32[3] = -std::numeric_limits<float>::denorm_min();
  for (double& x : wide.positions.f64) {
    do x = std::bit_cast<double>(random());
    while (!std::isfinite(x) || std::abs(x) > 0x1p300);
  }
  wide.positions.f64[0] = -0.0;
  wide.positions.f64[1] = std::numeric_limits<double>::denorm_min();
  for (const SourceMesh& each : {mesh, wide}) {
    const test::CookedTree cooked = test::cook_tree(each, GetParam());
    EXPECT_EQ(decoded(cooked.tree), source(each));
  }
}

// Triangles of few vertices in no order: leaves refer to vertices of all others.
TEST_P(ExactStore, RefersToVerticesOfManyLeaves) {
  std::mt19937 random(3);
  SourceMesh mesh = test::soup(1, 1);
  mesh.positions.f32.clear();
  mesh.faces.clear();
  for (int i = 0; i < 3 * 200; ++i) {
    mesh.positions.f32.push_back(static_cast<float>(random() % 1000));
  }
  for (int i = 0; i < 500; ++i) {
    const auto vertex = [&] { return static_cast<std::uint32_t>(random() % 200); };
    mesh.faces.push_back({{vertex(), vertex(), vertex(), kNoCorner}});
  }
  const test::CookedTree cooked = test::cook_tree(mesh, GetParam());
  EXPECT_EQ(decoded(cooked.tree), source(mesh));
}

// The same leaves with `gap` zero bytes more between each two: a file that other writers may make.
cooker::EncodedTree with_gaps(const SourceMesh& mesh, CodecId codec, std::uint16_t gap) {
  const test::CookedTree cooked = test::cook_tree(mesh, codec);
  const ClusterView& view = BoundTree::of(cooked.tree).leaves().clusters();
  Cluster cluster;
  EXPECT_TRUE(find_cluster(view, 0, cluster));
  cooker::EncodedTree spread = test::require(cooker::cook_as(mesh, codec, {}));
  std::vector<std::byte>& bytes = spread.geometry.vertices;
  const std::size_t leaves = leaves_of(view.face_count);
  bytes.assign(view.bytes.size() + leaves * gap + kClusterUnit, std::byte{0});
  const std::size_t table = cluster_table_bytes(view.face_count);
  auto header = load<ClusterHeader>(cluster.bytes);
  std::copy_n(view.bytes.begin(), table + header.leaves_at, bytes.begin());
  header.start_slope =
      static_cast<std::uint16_t>(header.start_slope + (gap << ClusterHeader::kSlopeBits));
  std::memcpy(bytes.data() + table, &header, sizeof(header));
  std::uint64_t end = 0;
  FoundCluster found;
  for (std::uint32_t i = 0; i < leaves; ++i) {
    ClusterLeaf leaf;
    ClusterLeafFields fields;
    EXPECT_TRUE(decode_cluster_leaf(view, i, found, leaf, &fields));
    for (std::uint64_t bit = fields.begin; bit < fields.end; ++bit) {
      write_bits(bytes.data(), bit + std::uint64_t{8} * gap * i, 1,
                 read_bits(view.bytes.data(), bit, 1));
    }
    end = (fields.end + 7) / 8 + std::uint64_t{gap} * i;
  }
  bytes.resize((end + kClusterUnit - 1) / kClusterUnit * kClusterUnit + kClusterPadding);
  return spread;
}

void expect_equal_answers(const Tree& found, const Tree& expected) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-2, 2);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d point(place(random), place(random), place(random));
    const PointResult of_expected = closest_point(expected, point);
    const PointResult of_found = closest_point(found, point);
    ASSERT_TRUE(of_expected);
    ASSERT_EQ(of_found.code(), Errc::kOk);
    ASSERT_TRUE(of_found);
    EXPECT_EQ(of_found->distance, of_expected->distance);
  }
}

// Leaves lie more than 2^16 bytes after the first.
TEST_P(ExactStore, LeavesMayLieFarApart) {
  const SourceMesh mesh = test::torus(16, 12);
  ASSERT_LE(mesh.faces.size(), kClusterFaces);
  const test::CookedTree cooked = test::cook_tree(mesh, GetParam());
  const cooker::EncodedTree spread = with_gaps(mesh, GetParam(), 4096);
  const std::vector<std::byte> bytes = cooker::serialize(std::span(&spread, 1));
  const File file = test::require(File::open(Bytes(bytes)));
  EXPECT_TRUE(cooker::verify_file(file).empty());
  const Tree tree = test::require(Tree::bind(file));
  EXPECT_EQ(decoded(tree), source(mesh));
  expect_equal_answers(tree, cooked.tree);
}

// Offsets of every width, alone and together: vectors cut them out of one, two or three words of 32
// bits, and leave clusters with more vertices than their products of 16 bits can tell apart to the
// decoder of one leaf.
TEST_P(ExactStore, AnswersAreThoseOfArrays) {
  std::mt19937 random(5);
  for (const float span : {0x1p-20f, 0x1p-12f, 0x1p-4f, 1.0f}) {
    for (const float at : {1.0f, 0.0f, -1.0f}) {
      for (const bool is_welded : {true, false}) {
        // No face of the soup shares a vertex: three for each.
        SourceMesh mesh = is_welded ? test::torus(24, 12) : test::soup(600, 9);
        std::uniform_real_distribution<float> noise(-span / 16, span / 16);
        for (float& x : mesh.positions.f32) x = at + x * span + noise(random);
        cooker::CookOptions arrays;
        arrays.geometry = GeometryId::kArrays;
        expect_equal_answers(test::cook_tree(mesh, GetParam()).tree,
                             test::cook_tree(mesh, GetParam(), arrays).tree);
      }
    }
  }
}

// A torus of quads and, in places, of two triangles instead of one.
SourceMesh torus_of_quads(std::uint32_t around, std::uint32_t across, std::uint32_t split_every) {
  SourceMesh mesh = test::soup(1, 1);
  mesh.positions.f32.clear();
  mesh.faces.clear();
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const float a = 6.2831853f * static_cast<float>(i) / static_cast<float>(around);
      const float b = 6.2831853f * static_cast<float>(j) / static_cast<float>(across);
      const float radius = 1 + 0.4f * std::cos(b);
      mesh.positions.f32.insert(mesh.positions.f32.end(),
                                {radius * std::cos(a), radius * std::sin(a), 0.4f * std::sin(b)});
      const auto at = [&](std::uint32_t p, std::uint32_t q) {
        return p % around * across + q % across;
      };
      const std::uint32_t corner[] = {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
      if ((i * across + j) % split_every != 0) {
        mesh.faces.push_back({{corner[0], corner[1], corner[2], corner[3]}});
      } else {
        mesh.faces.push_back({{corner[0], corner[1], corner[2], kNoCorner}});
        mesh.faces.push_back({{corner[0], corner[2], corner[3], kNoCorner}});
      }
    }
  }
  return mesh;
}

// Vectors read leaves with quads, too, in the order in which others do.
TEST_P(ExactStore, LeavesWithQuadsAnswerAsThoseOfArrays) {
  std::mt19937 random(13);
  std::uniform_real_distribution<double> place(-1.5, 1.5);
  for (const std::uint32_t split_every : {1u, 2u, 5u, 9u, 100u}) {
    const SourceMesh mesh = torus_of_quads(24, 20, split_every);
    cooker::CookOptions options;
    options.geometry = GeometryId::kArrays;
    const test::CookedTree expected = test::cook_tree(mesh, GetParam(), options);
    const test::CookedTree found = test::cook_tree(mesh, GetParam());
    ASSERT_EQ(decoded(found.tree), source(mesh));
    expect_equal_answers(found.tree, expected.tree);
    std::size_t hits = 0, halves = 0;
    for (int i = 0; i < 300; ++i) {
      const Ray ray{{place(random), place(random), 3}, {place(random) / 9, place(random) / 9, -1}};
      const RayResult of_expected = closest_hit(expected.tree, ray);
      const RayResult of_found = closest_hit(found.tree, ray);
      ASSERT_EQ(of_found.has_value(), of_expected.has_value());
      if (!of_found) continue;
      ++hits;
      halves += of_found->triangle;
      EXPECT_EQ(of_found->t, of_expected->t);
      EXPECT_EQ(of_found->face.id, of_expected->face.id);
      EXPECT_EQ(of_found->triangle, of_expected->triangle);
      const auto faces_in_box = [&](const Tree& tree) {
        std::vector<std::uint32_t> ids;
        const Eigen::Vector3d at = ray.origin + of_found->t * ray.direction;
        EXPECT_TRUE(
            overlap_box(tree, {at.array() - 0.1, at.array() + 0.1}, [&](const FaceRef& face) {
              ids.push_back(face.id);
              return true;
            }).ok());
        std::sort(ids.begin(), ids.end());
        return ids;
      };
      EXPECT_EQ(faces_in_box(found.tree), faces_in_box(expected.tree));
    }
    EXPECT_GT(hits, 50u);
    EXPECT_EQ(halves == 0, split_every == 1);
    Pose pose = Pose::Identity();
    pose.translation() = Eigen::Vector3d(0.9, 0.1, 0.2);
    const auto pairs = [&](const Tree& tree) {
      std::vector<std::pair<std::uint32_t, std::uint32_t>> ids;
      EXPECT_TRUE(overlap_pairs(tree, Pose::Identity(), tree, pose, [&](const FacePair& pair) {
                    ids.emplace_back(pair.first.id, pair.second.id);
                    return true;
                  }).ok());
      std::sort(ids.begin(), ids.end());
      return ids;
    };
    const auto of_found = pairs(found.tree);
    EXPECT_EQ(of_found, pairs(expected.tree));
    EXPECT_FALSE(of_found.empty());
  }
}

INSTANTIATE_TEST_SUITE_P(WideCodecs, ExactStore, testing::Values(CodecId::kWide8, CodecId::kWide4),
                         [](const auto& test) { return std::string(codec_name(test.param)); });

TEST(NumbersOfFloats, KeepTheOrderOfFloatsAndTellZerosApart) {
  const float rising[] = {
      -std::numeric_limits<float>::max(), -1.0f, -0x1p-149f, -0.0f, 0.0f, 0x1p-149f, 1.0f,
      std::numeric_limits<float>::max()};
  const std::int32_t numbers[] = {-1 - 0x7f7fffff, -1 - 0x3f800000, -2, -1, 0, 1,
                                  0x3f800000,      0x7f7fffff};
  for (std::size_t i = 0; i < std::size(rising); ++i) {
    EXPECT_EQ(std::bit_cast<std::uint32_t>(float_of_number(numbers[i], 0)),
              std::bit_cast<std::uint32_t>(rising[i]));
  }
  EXPECT_EQ(float_of_number(0x3f8000, 8), 1.0f);
  EXPECT_EQ(float_of_number(-1 - 0x3f8000, 8), -1.0f);
  EXPECT_EQ(double_of_number(-1 - 0x3ff00000, 32), -1.0);
}

}  // namespace
}  // namespace boxtree
