// SPDX-License-Identifier: MIT
// Encoders: literal nodes of a tree small enough to work out by hand, and decoded boxes that hold
// what they must however awkward the numbers.
#include <random>

#include <gtest/gtest.h>

#include "cooker/encode/encoders.h"
#include "cooker/proof/proof.h"
#include "format/codec_plain.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"

namespace boxtree::cooker {
namespace {

// Two unit triangles, three apart on x. The largest extent, 4, becomes 2^14 in tree space.
SourceMesh two_triangles() {
  SourceMesh mesh;
  mesh.positions.f32 = {0, 0, 0, 1, 0, 0, 0, 1, 0, 3, 0, 0, 4, 0, 0, 3, 1, 0};
  mesh.faces = {{{0, 1, 2, kNoCorner}}, {{3, 4, 5, kNoCorner}}};
  return mesh;
}

TEST(PlainNodes, OfTwoTrianglesAreAsWorkedOutByHand) {
  const BuildTree build = build_tree(two_triangles(), Builder::kSah);
  EXPECT_EQ(build.scale_exponent, -12);
  const EncodedNodes nodes = encode_plain(build, two_triangles(), PlainCut::kF32, FaceOrder::kTree);
  EXPECT_EQ(nodes.root_box, (Box<double>{{0, 0, 0}, {16384, 4096, 0}}));
  ASSERT_EQ(nodes.node_count, 1u);
  const auto node = load<PlainNodeF32>(nodes.bytes.data());
  EXPECT_EQ(node.cutplane, plain_cutplane(0, PlainChild::kLeaf, PlainChild::kLeaf));
  EXPECT_EQ(node.child[0], 0u);
  EXPECT_EQ(node.child[1], 1u);
  EXPECT_EQ(node.cut[0], 12288.0f);  // 4 - 1 units
  EXPECT_EQ(node.cut[1], 12288.0f);  // 3 - 0 units
  const EncodedNodes half = encode_plain(build, two_triangles(), PlainCut::kF16, FaceOrder::kTree);
  EXPECT_EQ(load<PlainNodeF16>(half.bytes.data()).cut[0], 0x7200);  // 1.5 * 2^13
  EXPECT_EQ(half.depth, 1u);
  EXPECT_EQ(half.leaf_count, 2u);
  EXPECT_EQ(half.shrink_count, 0u);
}

// The larger the slab that must be empty, the fewer are cut off; every tree holds its triangles.
TEST(PlainNodes, ShrinkShareDecidesHowManySlabsAreCutOff) {
  const SourceMesh mesh = test::terrain(20, 3);
  const BuildTree build = build_tree(mesh, Builder::kSah);
  std::uint32_t last = ~std::uint32_t{0};
  for (const double share : {0.02, 0.15, 0.5, 1.0}) {
    const EncodedNodes nodes = encode_plain(build, mesh, PlainCut::kF32, FaceOrder::kTree, share);
    EXPECT_LT(nodes.shrink_count, last) << share;
    EXPECT_EQ(nodes.node_count, nodes.leaf_count - 1 + nodes.shrink_count);
    last = nodes.shrink_count;
    CookOptions options;
    options.shrink_share = share;
    for (const CodecId codec : {CodecId::kPlainF16, CodecId::kPackedF32, CodecId::kPackedF64}) {
      options.codec = codec;
      const auto cooked = cook_mesh(mesh, options);
      ASSERT_TRUE(cooked);
      EXPECT_TRUE(cooked->contest.candidates.front().gates.pass()) << share;
    }
  }
  EXPECT_EQ(last, 0u);
}

TEST(ExpectedVisits, OfTwoTrianglesAreTheRootAlone) {
  const BuildTree build = build_tree(two_triangles(), Builder::kSah);
  const EncodedNodes nodes = encode_plain(build, two_triangles(), PlainCut::kF32, FaceOrder::kTree);
  EXPECT_EQ(nodes.visits.ray, 1);
  EXPECT_EQ(nodes.visits.box, 1);
  EXPECT_EQ(nodes.visits.pair, 1);
}

TEST(ArrayGeometry, StandsInTreeOrderWithVerticesInOrderOfUse) {
  SourceMesh mesh = two_triangles();
  std::swap(mesh.faces[0], mesh.faces[1]);  // source order is not tree order
  const BuildTree build = build_tree(mesh, Builder::kSah);
  const EncodedGeometry geometry = encode_array_geometry(mesh, faces_in_tree_order(build));
  EXPECT_EQ(geometry.corner_bytes, 2);
  EXPECT_EQ(geometry.corners_per_face, 3);
  ASSERT_EQ(geometry.vertices.size(), 6 * 12u);
  ASSERT_EQ(geometry.corners.size(), 6 * 2u);
  for (std::uint16_t i = 0; i < 6; ++i) {
    EXPECT_EQ(load<std::uint16_t>(geometry.corners.data(), i), i);
  }
  EXPECT_EQ(load<float>(geometry.vertices.data(), 3), 1.0f);  // vertex 1 of the left triangle
}

TEST(ArrayGeometry, CornersTakeFourBytesWhenTwoCannotMarkAMissingOne) {
  for (const std::size_t vertices : {0xffffu, 0x10000u}) {
    SourceMesh mesh;
    for (std::size_t i = 0; i < vertices; ++i) {
      mesh.positions.f32.insert(mesh.positions.f32.end(), {static_cast<float>(i), 0, 0});
      const auto v = static_cast<std::uint32_t>(i);
      mesh.faces.push_back({{v, v, v, kNoCorner}});
    }
    mesh.faces.push_back({{0, 1, 2, 3}});
    const EncodedGeometry geometry =
        encode_array_geometry(mesh, faces_in_tree_order(build_tree(mesh, Builder::kSah)));
    EXPECT_EQ(geometry.corner_bytes, vertices == 0xffff ? 2 : 4);
  }
}

class Encoders : public testing::TestWithParam<CodecId> {};

// Coordinates of every magnitude side by side, where rounding swallows cuts.
TEST_P(Encoders, HoldEveryTriangleWhateverTheMagnitudes) {
  std::mt19937 random(5);
  for (int round = 0; round < 40; ++round) {
    SourceMesh mesh;
    const int spread = 1 + round;
    for (std::uint32_t i = 0; i < 300; ++i) {
      const std::uint32_t v = 3 * i;
      mesh.faces.push_back({{v, v + 1, v + 2, kNoCorner}});
      for (int c = 0; c < 9; ++c) {
        const int exponent =
            static_cast<int>(random() % static_cast<unsigned>(spread)) - spread / 2;
        const float sign = random() % 2 == 0 ? 1.0f : -1.0f;
        mesh.positions.f32.push_back(
            sign * std::ldexp(1 + static_cast<float>(random() % 0x800000) * 0x1p-23f, exponent));
      }
    }
    const test::CookedTree cooked = test::cook_tree(mesh, GetParam());
    const Findings findings = verify_file(cooked.file);
    ASSERT_TRUE(findings.empty()) << "spread " << spread << ": " << findings.front().message();
  }
}

INSTANTIATE_TEST_SUITE_P(Codecs, Encoders, testing::ValuesIn(test::all_codecs()), test::test_name);

}  // namespace
}  // namespace boxtree::cooker
