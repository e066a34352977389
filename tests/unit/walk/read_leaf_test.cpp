// SPDX-License-Identifier: MIT
// Whole leaves by vectors, in every instruction set, and those that walks by NEON read, against
// LeafReader, which reads them number by number: the same triangles to the bit, of every store, and
// the same errors of corrupt bytes.
#include "runtime/walk/read_leaf.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "runtime/tree/plain_cluster.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/unit/walk/targets.h"

namespace boxtree {
namespace {

using cooker::SourceMesh;

// What a batch holds, with the bits of its coordinates: -0 is not 0.
std::vector<std::uint64_t> content_of(const TriangleBatch& batch) {
  std::vector<std::uint64_t> content;
  for (std::uint32_t i = 0; i < batch.count; ++i) {
    content.push_back(batch.face[i]);
    for (const auto& axes : batch.coordinate) {
      for (const auto& lanes : axes) content.push_back(std::bit_cast<std::uint64_t>(lanes[i]));
    }
  }
  return content;
}

// The triangles of a leaf in two parts, which no reader of whole leaves reads, and the first error.
std::pair<Errc, std::vector<std::uint64_t>> read_in_parts(const LeafReader& leaves, NodeRef leaf) {
  std::vector<std::uint64_t> content;
  TriangleBatch part;
  const std::uint32_t first_count = leaf.second / 2;
  for (const auto& [first, count] :
       {std::pair(leaf.first, first_count),
        std::pair(leaf.first + first_count, leaf.second - first_count)}) {
    if (count == 0) continue;
    const Errc error = leaves.read(first, count, part);
    if (error != Errc::kOk) return {error, {}};
    const std::vector<std::uint64_t> more = content_of(part);
    content.insert(content.end(), more.begin(), more.end());
  }
  return {Errc::kOk, content};
}

// The three corners of a triangle, each rounded to floats, in any order.
using FloatCorners = std::array<std::array<float, 3>, 3>;
FloatCorners in_order(FloatCorners corners) {
  std::sort(corners.begin(), corners.end());
  return corners;
}

// A full leaf of clusters by PlainClusterReader, which walks by NEON use, against that of
// LeafReader: the exact triangles, the faces and, in floats, the corners but for a turn. It finds
// corrupt bytes, too, but not that a coordinate is out of range, which LeafFloats looks for, and
// leaves large groups to LeafReader.
void compare_plain_leaf(const LeafReader& leaves, std::uint32_t first, Errc error,
                        const TriangleBatch& expected) {
  DoublePositions doubles;
  LeafTriangles triangles;
  LeafCoordinates floats;
  PlainClusterReader reader(leaves.clusters(), leaves.frame(), doubles);
  const auto scale = static_cast<float>(leaves.stored_scale());
  if (!reader.read(first / kLeafFaces, scale, triangles, floats)) {
    Cluster cluster;
    const bool is_found = find_cluster(leaves.clusters(), first / kClusterFaces, cluster);
    const bool has_large_groups =
        is_found && cluster.header().group_size() > ClusterHeader::kFastGroupSize;
    EXPECT_TRUE(error != Errc::kOk || has_large_groups) << "leaf at " << first;
    return;
  }
  if (error != Errc::kOk) {
    EXPECT_EQ(error, Errc::kVertexNotFinite) << "leaf at " << first;
    return;
  }
  ASSERT_EQ(triangles.count, expected.count);
  for (std::uint32_t lane = 0; lane < triangles.count; ++lane) {
    EXPECT_EQ(first + triangles.face_and_half(lane) / 2, expected.face[lane]);
    std::uint32_t references[3];
    triangles.find_corners(lane, references);
    double stored[3][4];
    triangles.read_corners(lane, leaves.clusters().numbers, stored);
    FloatCorners in_floats, exact;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double position = leaves.is_from_origin() ? stored[c][k] * leaves.stored_scale()
                                                        : doubles[references[c]][k];
        EXPECT_EQ(std::bit_cast<std::uint64_t>(position),
                  std::bit_cast<std::uint64_t>(expected.coordinate[c][k][lane]));
        in_floats[c][k] = floats[c][k][lane];
        exact[c][k] = static_cast<float>(position);
      }
    }
    EXPECT_EQ(in_order(in_floats), in_order(exact));
  }
}

// Reads every leaf in all ways. Returns how many were read without an error.
std::uint32_t compare_leaves(const Tree& bound, const char* name) {
  const BoundTree& tree = BoundTree::of(bound);
  const std::uint32_t faces = tree.leaves().mesh().face_count;
  std::uint32_t read = 0;
  TriangleBatch expected, actual;
  for (std::uint32_t first = 0; first < faces; first += kLeafFaces) {
    const NodeRef leaf{first, std::min(kLeafFaces, faces - first)};
    const Errc error = tree.leaves().read(leaf.first, leaf.second, expected);
    EXPECT_EQ(read_leaf(tree, leaf, actual), error) << name << ", leaf at " << first;
    const auto [error_of_parts, parts] = read_in_parts(tree.leaves(), leaf);
    EXPECT_EQ(error_of_parts, error) << name << ", leaf at " << first;
    if (tree.leaves().has_clusters() && leaf.second == kLeafFaces) {
      compare_plain_leaf(tree.leaves(), first, error, expected);
    }
    if (error != Errc::kOk) continue;
    EXPECT_EQ(parts, content_of(expected)) << name << ", leaf at " << first;
    EXPECT_EQ(content_of(actual), content_of(expected)) << name << ", leaf at " << first;
    ++read;
  }
  return read;
}

// Coordinates of every magnitude, of both signs and zeros.
SourceMesh any_numbers() {
  SourceMesh mesh = test::soup(500, 3);
  std::mt19937 random(4);
  for (float& x : mesh.positions.f32) {
    x = std::ldexp(x, static_cast<int>(random() % 60) - 30);
    if (random() % 7 == 0) x = random() % 2 == 0 ? 0.0f : -0.0f;
  }
  return mesh;
}

// The same in double precision, with digits that floats do not have.
SourceMesh in_doubles(SourceMesh mesh) {
  for (const float x : mesh.positions.f32) mesh.positions.f64.push_back(double{x} * (1 + 0x1p-40));
  mesh.positions.f32.clear();
  mesh.positions.precision = cooker::Precision::kF64;
  mesh.name += ", f64";
  return mesh;
}

std::vector<SourceMesh> meshes() {
  std::vector<SourceMesh> all = test::all_kinds();
  all.push_back(any_numbers());
  for (std::size_t i = all.size(); i-- > 0;) {
    if (!all[i].positions.f32.empty()) all.push_back(in_doubles(all[i]));
  }
  return all;
}

TEST(ReadLeaf, GivesTheTrianglesOfLeafReader) {
  for (const SourceMesh& mesh : meshes()) {
    for (const test::Encoding& encoding : test::all_encodings()) {
      const test::CookedTree cooked = test::cook_tree(mesh, encoding);
      for_each_target([&](const char* target) {
        EXPECT_GT(compare_leaves(cooked.tree, target), 0u) << mesh.name;
      });
    }
  }
}

#ifdef BOXTREE_TEST_TARGETS
// Otherwise the tests here compare LeafReader with itself.
TEST(ReadLeaf, IsByVectorsWhereTheMachineHasEightLanes) {
  for (const GeometryId geometry : {GeometryId::kExact, GeometryId::kGrid}) {
    for (const SourceMesh& mesh : {test::torus(24, 16), in_doubles(test::torus(24, 16))}) {
      const test::CookedTree cooked = test::cook_tree(mesh, {CodecId::kWide8, geometry});
      for_each_target([&](const char* target) {
        const bool has_eight_lanes = std::string_view(target).starts_with("AVX");
        TriangleBatch batch;
        EXPECT_EQ(read_leaf_wide(BoundTree::of(cooked.tree), {0, kLeafFaces}, batch),
                  has_eight_lanes)
            << mesh.name;
      });
    }
  }
}
#endif

// The file lies alone on the heap, where the address sanitizer and valgrind see every read outside.
TEST(ReadLeaf, OfCorruptClustersHasTheSameErrors) {
  for (const GeometryId geometry : {GeometryId::kExact, GeometryId::kGrid}) {
    for (const SourceMesh& mesh :
         {test::torus(24, 16), test::city(6, 1), any_numbers(), in_doubles(test::torus(24, 16)),
          in_doubles(test::city(6, 1)), in_doubles(any_numbers())}) {
      const test::CookedTree whole = test::cook_tree(mesh, {CodecId::kWide8, geometry});
      std::mt19937 random(5);
      std::uint32_t refused = 0, read = 0;
      for (int round = 0; round < 200; ++round) {
        std::vector<std::byte> bytes = whole.bytes;
        const std::span<std::byte> clusters = test::section_of(bytes, SectionKind::kVertices);
        for (int change = 0; change < 1 + round / 8; ++change) {
          clusters[random() % clusters.size()] ^= std::byte{1} << (random() % 8);
        }
        test::repair_checksums(bytes);
        const Result<File> file = File::open(Bytes(bytes));
        ASSERT_TRUE(file.ok());
        const Result<Tree> tree = Tree::bind(*file);
        if (!tree) continue;
        const std::uint32_t leaves = (tree->face_count() + kLeafFaces - 1) / kLeafFaces;
        for_each_target([&](const char* target) {
          const std::uint32_t good = compare_leaves(*tree, target);
          read += good;
          refused += leaves - good;
        });
      }
      EXPECT_GT(read, 0u) << mesh.name;
      EXPECT_GT(refused, 0u) << mesh.name;
    }
  }
}

}  // namespace
}  // namespace boxtree
