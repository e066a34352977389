// SPDX-License-Identifier: MIT
// Frustums against every triangle cut by six planes in extended precision.
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "tests/support/cooked.h"
#include "tests/support/frustum_reference.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"

namespace boxtree {
namespace {

using cooker::SourceMesh;
using test::LongTriangle;

std::set<std::uint32_t> visited(const Tree& tree, const Frustum& frustum) {
  std::set<std::uint32_t> faces;
  EXPECT_EQ(test::require(overlap_frustum(tree, frustum,
                                          [&](const FaceRef& face) {
                                            EXPECT_TRUE(faces.insert(face.index).second);
                                            return true;
                                          })),
            Visit::kComplete);
  return faces;
}

class Frustums : public testing::TestWithParam<test::Encoding> {
 protected:
  double unit() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  Eigen::Vector3d vector() { return {unit(), unit(), unit()}; }

  Frustum drawn(const Eigen::AlignedBox3d& box, int i) {
    const double size = box.diagonal().norm();
    const Eigen::Vector3d eye = box.center() + size * vector();
    const Eigen::Vector3d target = box.center() + 0.3 * size * vector();
    if (i % 3 == 0) {
      return Frustum::of(test::view_projection(eye, target, 0.2 + 0.5 * std::abs(unit()),
                                               0.01 * size, (1 + unit()) * size + 0.02 * size));
    }
    if (i % 3 == 1) {  // a box whose sides meet corners of the mesh
      const Eigen::Vector3d low = box.center() + 0.4 * vector().cwiseProduct(box.sizes());
      const Eigen::Vector3d high = low + 0.3 * box.sizes();
      std::array<Eigen::Vector3d, 8> corners;
      for (std::size_t c = 0; c < 8; ++c) {
        const bool right = c % 4 == 1 || c % 4 == 2, top = c % 4 >= 2, behind = c >= 4;
        corners[c] = {right ? high[0] : low[0], top ? high[1] : low[1], behind ? high[2] : low[2]};
      }
      return Frustum::of(corners);
    }
    Frustum frustum;
    for (Frustum::Plane& plane : frustum.planes) {
      const Eigen::Vector3d normal = vector();
      plane << normal, -normal.dot(box.center()) + 0.2 * size * normal.norm();
    }
    return frustum;
  }

  std::mt19937_64 random_{3};
};

TEST_P(Frustums, HaveTheFacesOfExtendedPrecision) {
  std::size_t found = 0;
  for (const SourceMesh& mesh : test::all_kinds()) {
    SCOPED_TRACE(mesh.name);
    const test::CookedTree cooked = test::cook_tree(mesh, GetParam());
    const std::vector<test::BoundedTriangle> triangles = test::bounded_triangles(cooked.tree);
    const long double size = cooked.tree.bounds()
                                 .min()
                                 .cwiseAbs()
                                 .cwiseMax(cooked.tree.bounds().max().cwiseAbs())
                                 .maxCoeff();
    for (int i = 0; i < 60; ++i) {
      SCOPED_TRACE(i);
      const Frustum frustum = drawn(cooked.tree.bounds(), i);
      const std::set<std::uint32_t> faces = visited(cooked.tree, frustum);
      found += faces.size();
      std::set<std::uint32_t> may;
      for (std::uint32_t f = 0; f < cooked.tree.face_count(); ++f) {
        for (std::uint32_t half = 0; half < 2; ++half) {
          const Result<Triangle> triangle = cooked.tree.triangle({kNoFaceId, f}, half);
          if (!triangle) continue;
          const LongTriangle exact = test::long_triangle(*triangle);
          if (test::touches(frustum, exact, size, 0)) {
            ASSERT_TRUE(faces.contains(f)) << f;
          }
          if (test::touches(frustum, exact, size, 0x1p-46L)) may.insert(f);
        }
      }
      for (const std::uint32_t f : faces) ASSERT_TRUE(may.contains(f)) << f;
    }
  }
  EXPECT_GT(found, 1000u);
}

TEST_P(Frustums, WithoutAFarPlaneOrWithoutAny) {
  const test::CookedTree cooked = test::cook_tree(test::sphere(8, 8), GetParam());
  Frustum all;
  for (Frustum::Plane& plane : all.planes) plane << 0, 0, 0, 1;
  EXPECT_EQ(visited(cooked.tree, all).size(), cooked.tree.face_count());
  all.planes[3] << 0, 0, 0, -1;
  EXPECT_TRUE(visited(cooked.tree, all).empty());
  all.planes[3] << 0, 0, 1e300, 0;
  const std::size_t upper = visited(cooked.tree, all).size();
  EXPECT_GT(upper, 0u);
  EXPECT_LT(upper, cooked.tree.face_count());
  all.planes[3] << 0, 0, 1e-300, 0;
  EXPECT_EQ(visited(cooked.tree, all).size(), upper);
}

INSTANTIATE_TEST_SUITE_P(Encodings, Frustums, testing::ValuesIn(test::all_encodings()),
                         test::encoding_name);

TEST(Frustum, DepthsOfBothKindsAndReversed) {
  const test::CookedTree cooked = test::cook_tree(test::terrain(8, 1), CodecId::kWide8);
  const Eigen::Vector3d center = cooked.tree.bounds().center();
  const double size = cooked.tree.bounds().diagonal().norm();
  const Frustum::ViewProjection matrix = test::view_projection(
      center + Eigen::Vector3d(0.2, 0.3, 0.8) * size, center, 0.5, 0.5 * size, 0.9 * size);
  const std::set<std::uint32_t> faces = visited(cooked.tree, Frustum::of(matrix));
  EXPECT_GT(faces.size(), 0u);
  EXPECT_LT(faces.size(), cooked.tree.face_count());
  Frustum::ViewProjection open_gl = matrix, reversed = matrix;
  open_gl.row(2) = 2 * matrix.row(2) - matrix.row(3);
  EXPECT_EQ(visited(cooked.tree, Frustum::of(open_gl, ClipDepth::kMinusOneToOne)), faces);
  reversed.row(2) = matrix.row(3) - matrix.row(2);
  EXPECT_EQ(visited(cooked.tree, Frustum::of(reversed)), faces);
}

TEST(Frustum, OfNumbersThatAreNotFiniteIsAnError) {
  const test::CookedTree cooked = test::cook_tree(test::sphere(8, 8), CodecId::kWide8);
  const auto none = [](const FaceRef&) { return true; };
  Frustum frustum;
  for (Frustum::Plane& plane : frustum.planes) plane << 0, 0, 1, 1;
  frustum.planes[2][3] = INFINITY;
  EXPECT_EQ(overlap_frustum(cooked.tree, frustum, none).error().detail, "planes");
  frustum.planes[2] << NAN, 0, 0, 1;
  EXPECT_EQ(overlap_frustum(cooked.tree, frustum, none).error().detail, "planes");
}

TEST(Frustum, OfAPyramidHasItsTip) {
  const test::CookedTree cooked = test::cook_tree(test::sphere(8, 8), CodecId::kWide8);
  std::array<Eigen::Vector3d, 8> corners;
  const double far = 10;
  corners.fill(Eigen::Vector3d(0, 0, 0));
  corners[4] = {-far, -far, far};
  corners[5] = {far, -far, far};
  corners[6] = {far, far, far};
  corners[7] = {-far, far, far};
  const std::set<std::uint32_t> faces = visited(cooked.tree, Frustum::of(corners));
  EXPECT_GT(faces.size(), 0u);
  EXPECT_LT(faces.size(), cooked.tree.face_count() / 2);
}

}  // namespace
}  // namespace boxtree
