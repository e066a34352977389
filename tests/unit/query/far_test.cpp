// SPDX-License-Identifier: MIT
// Meshes far from the origin: the same bytes and answers as near it where f32 holds both.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "cooker/export/decoded_faces.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"

namespace boxtree {
namespace {

using cooker::SourceMesh;

// So far that f32 has 12 bits for the shape, of which it needs 11.
constexpr float kFar = 4096;
constexpr float kSteps = 1024;

SourceMesh mesh_at(float x) {
  SourceMesh mesh = test::sphere(20, 24);
  for (std::size_t i = 0; i < mesh.positions.f32.size(); ++i) {
    float& p = mesh.positions.f32[i];
    p = std::round(p * kSteps) / kSteps + (i % 3 == 1 ? 0 : x);
  }
  return mesh;
}

class Far : public testing::TestWithParam<test::Encoding> {};

TEST_P(Far, AnswersAreThoseNearTheOrigin) {
  const test::CookedTree near = test::cook_tree(mesh_at(0), GetParam());
  const test::CookedTree far = test::cook_tree(mesh_at(kFar), GetParam());
  // Nearly as many bits for boxes as near the origin.
  EXPECT_LE(BoundTree::of(far.tree).largest_abs(), 0x1p15);
  EXPECT_TRUE(BoundTree::of(far.tree).has_float_nodes());
  const Eigen::Vector3d shift(kFar, 0, kFar);
  std::mt19937_64 random(3);
  std::uniform_int_distribution<int> steps(-3000, 3000);
  const auto point = [&]() -> Eigen::Vector3d {
    return Eigen::Vector3d(steps(random), steps(random), steps(random)) / double{kSteps};
  };
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d from = point(), to = point() / 2;
    const RayResult here = closest_hit(near.tree, {from, to - from});
    const RayResult there = closest_hit(far.tree, {from + shift, to - from});
    ASSERT_EQ(there.has_value(), here.has_value());
    if (here) {
      ++hits;
      ASSERT_EQ(there->face.id, here->face.id);
      ASSERT_NEAR(there->t, here->t, 1e-12);
    }
    const PointResult near_point = closest_point(near.tree, from);
    const PointResult far_point = closest_point(far.tree, from + shift);
    ASSERT_NEAR(far_point->distance, near_point->distance, 1e-12);
  }
  EXPECT_GT(hits, 500);
}

TEST_P(Far, PositionsOfTheSourceAreKept) {
  const SourceMesh mesh = mesh_at(kFar);
  const test::CookedTree far = test::cook_tree(mesh, GetParam());
  if (GetParam().geometry == GeometryId::kGrid || GetParam().geometry == GeometryId::kExternal) {
    return;
  }
  const cooker::DecodedFaces faces =
      test::require(cooker::DecodedFaces::decode(far.tree, cooker::ExportOrder::kSource));
  ASSERT_EQ(faces.face_count(), mesh.faces.size());
  for (std::uint32_t f = 0; f < faces.face_count(); ++f) {
    const auto corner = faces.face(f);
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_EQ(faces.position(corner[c]), mesh.positions[mesh.faces[f].corner[c]]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Encodings, Far, testing::ValuesIn(test::all_encodings()),
                         test::encoding_name);

// A row of cells that reaches from the origin to where its cells are far from it: positions on
// every axis whose middle is not eight extents away stay what they are, with -0.
TEST(FarAxis, NearAxesKeepTheirZeros) {
  SourceMesh mesh = mesh_at(kFar);
  for (std::size_t i = 1; i < mesh.positions.f32.size(); i += 3) {
    if (mesh.positions.f32[i] == 0) mesh.positions.f32[i] = -0.0f;
  }
  const test::CookedTree far =
      test::cook_tree(mesh, test::Encoding{CodecId::kWide8, GeometryId::kExact});
  EXPECT_EQ(BoundTree::of(far.tree).frame().origin[1], 0);
  EXPECT_NE(BoundTree::of(far.tree).frame().origin[0], 0);
  const cooker::DecodedFaces faces =
      test::require(cooker::DecodedFaces::decode(far.tree, cooker::ExportOrder::kSource));
  bool has_zero = false;
  for (std::uint32_t v = 0; v < faces.vertex_count(); ++v) {
    const double y = faces.position(v)[1];
    has_zero |= y == 0;
    EXPECT_FALSE(y == 0 && !std::signbit(y));
  }
  EXPECT_TRUE(has_zero);
}

}  // namespace
}  // namespace boxtree
