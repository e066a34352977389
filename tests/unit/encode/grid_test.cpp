// SPDX-License-Identifier: MIT
// The grid store against rounding done here, vertex by vertex: what is decoded is the source on the
// grid, face by face and corner by corner, in every codec.
#include "cooker/quantise/grid.h"

#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "cooker/proof/proof.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"

namespace boxtree {
namespace {

using cooker::CookOptions;
using cooker::SourceMesh;

CookOptions on_grid(int bits) {
  CookOptions options;
  options.geometry = GeometryId::kGrid;
  options.grid.bits = bits;
  return options;
}

// Corners of every face by its source number, as the tree has them, in object space.
std::map<std::uint32_t, std::vector<Eigen::Vector3d>> decoded_faces(const Tree& tree) {
  std::map<std::uint32_t, std::vector<Eigen::Vector3d>> faces;
  TriangleBatch batch;
  for (std::uint32_t f = 0; f < tree.face_count(); ++f) {
    EXPECT_EQ(BoundTree::of(tree).leaves().read(f, 1, batch), Errc::kOk);
    std::vector<Eigen::Vector3d>& corners = faces[BoundTree::of(tree).face_id(f)];
    EXPECT_TRUE(corners.empty()) << "face " << BoundTree::of(tree).face_id(f) << " occurs twice";
    for (const Eigen::Vector3d& corner : batch.triangle(0).corner) {
      corners.push_back(BoundTree::of(tree).frame().to_object(corner));
    }
    if (batch.count == 2)
      corners.push_back(BoundTree::of(tree).frame().to_object(batch.triangle(1).corner[2]));
  }
  return faces;
}

class GridStore : public testing::TestWithParam<CodecId> {};

TEST_P(GridStore, HoldsTheSourceRoundedToTheGrid) {
  for (const SourceMesh& mesh : test::all_kinds()) {
    for (const int bits : {8, 16, 24, 25, 30}) {
      SCOPED_TRACE(mesh.name + ", " + std::to_string(bits) + " bits");
      const cooker::EncodedTree encoded =
          test::require(cooker::cook_as(mesh, GetParam(), on_grid(bits)));
      const test::CookedTree cooked = test::cook_tree(mesh, GetParam(), on_grid(bits));
      const double step = std::ldexp(1.0, BoundTree::of(cooked.tree).grid_exponent());
      const Eigen::AlignedBox3d bounds = cooker::bounds_of(mesh);
      const double extent = bounds.diagonal().maxCoeff();
      EXPECT_LE(extent, step * std::ldexp(1.0, bits));
      EXPECT_GT(extent, step * std::ldexp(1.0, bits - 1) * (1 - 1e-12));
      const auto faces = decoded_faces(cooked.tree);
      ASSERT_EQ(faces.size(), mesh.faces.size());
      double farthest = 0;
      for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
        const std::vector<Eigen::Vector3d>& corners = faces.at(f);
        ASSERT_EQ(corners.size(), mesh.faces[f].is_quad() ? 4u : 3u);
        for (std::size_t c = 0; c < corners.size(); ++c) {
          const Eigen::Vector3d source = mesh.positions[mesh.faces[f].corner[c]];
          for (Eigen::Index k = 0; k < 3; ++k) {
            // The grid's origin is a multiple of its step, so rounding is to multiples.
            ASSERT_EQ(corners[c][k], std::floor(source[k] / step + 0.5) * step);
          }
          farthest = std::max(farthest, (corners[c] - source).norm());
        }
      }
      EXPECT_LE(encoded.geometry.max_vertex_error, 0.8661 * step);
      EXPECT_NEAR(encoded.geometry.max_vertex_error, farthest, 1e-12 * farthest);
      EXPECT_TRUE(cooker::verify_file(cooked.file).empty());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Codecs, GridStore, testing::ValuesIn(test::all_codecs()), test::test_name);

// Faces between random vertices of a lattice: of few vertices, leaves are strips that name most of
// them again; of many, each reference takes the most bits there are, as soon as a cluster has named
// hundreds.
SourceMesh between_vertices(std::uint32_t vertices, double share_of_quads, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<std::uint32_t> any(0, vertices - 1);
  std::bernoulli_distribution is_quad(share_of_quads);
  SourceMesh mesh;
  for (std::uint32_t i = 0; i < vertices; ++i) {
    for (const std::uint32_t x : {i % 8, i / 8 % 8, i / 64}) {
      mesh.positions.f32.push_back(static_cast<float>(x));
    }
  }
  while (mesh.faces.size() < 150) {
    cooker::Face face{{any(random), any(random), any(random), cooker::kNoCorner}};
    if (is_quad(random)) face.corner[3] = any(random);
    const std::set<std::uint32_t> different(face.corner.begin(), face.corner.end());
    if (different.size() == 4) mesh.faces.push_back(face);
  }
  return mesh;
}

TEST(Grid, LeavesComeBackHoweverManyBitsTheirFacesTake) {
  for (const std::uint32_t vertices : {5u, 31u, 500u}) {
    for (const double share_of_quads : {0.0, 0.5, 1.0}) {
      SCOPED_TRACE(std::to_string(vertices) + " vertices, " + std::to_string(share_of_quads));
      const SourceMesh mesh = between_vertices(vertices, share_of_quads, vertices);
      const test::CookedTree cooked = test::cook_tree(mesh, CodecId::kWide8, on_grid(8));
      const auto faces = decoded_faces(cooked.tree);
      ASSERT_EQ(faces.size(), mesh.faces.size());
      for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
        const std::vector<Eigen::Vector3d>& corners = faces.at(f);
        ASSERT_EQ(corners.size(), mesh.faces[f].is_quad() ? 4u : 3u);
        for (std::size_t c = 0; c < corners.size(); ++c) {
          ASSERT_EQ(corners[c], mesh.positions[mesh.faces[f].corner[c]]) << f;
        }
      }
    }
  }
}

// Steps of 3, 4 and 12 along the axes are 13 in all. Their squares are neither too large nor too
// small for double, though those of the lengths are.
TEST(Grid, SaysHowFarAVertexMovesToTheBit) {
  for (const int exponent : {-900, 0, 900}) {
    const double extent = std::ldexp(1.0, exponent);
    const double step = extent / 4096;
    SourceMesh mesh;
    mesh.positions.precision = cooker::Precision::kF64;
    mesh.positions.f64 = {
        0, 0, 0, extent, extent, extent, step * 3 / 32, step * 4 / 32, step * 12 / 32};
    mesh.faces = {{{0, 1, 2, cooker::kNoCorner}}};
    const cooker::EncodedTree tree =
        test::require(cooker::cook_as(mesh, CodecId::kWide4, on_grid(12)));
    EXPECT_EQ(tree.geometry.max_vertex_error, step * 13 / 32);
  }
}

TEST(Grid, HoldsATolerance) {
  const SourceMesh mesh = test::torus(40, 30);
  for (const double tolerance : {0.3, 0.01, 1e-3, 3.3e-5, 1e-7}) {
    CookOptions options = on_grid(8);
    options.grid.tolerance = tolerance;
    const cooker::EncodedTree tree = test::require(cooker::cook_as(mesh, CodecId::kWide4, options));
    EXPECT_LE(tree.geometry.max_vertex_error, tolerance);
    // And is not finer than it must be.
    CookOptions coarser = options;
    coarser.grid = {.step_exponent = tree.geometry.grid_exponent + 1};
    const cooker::EncodedTree beyond =
        test::require(cooker::cook_as(mesh, CodecId::kWide4, coarser));
    EXPECT_GT(beyond.geometry.max_vertex_error, tolerance);
  }
  CookOptions options = on_grid(8);
  options.grid.tolerance = 1e-12;
  EXPECT_EQ(cooker::cook_as(mesh, CodecId::kWide4, options).code(), Errc::kMeshUnsupported);
}

// Of a tolerance, a grid gets what f32 left of it.
TEST(Grid, ToleranceIsOfTheSourceThatF32HasMoved) {
  SourceMesh mesh = test::torus(40, 30);
  for (const double moved : {0.009, 0.1 + 0.2, 0.01}) {
    mesh.moved_by_f32 = moved;
    for (const double tolerance : {0.01, 0.31, 0.5}) {
      CookOptions options = on_grid(8);
      options.grid.tolerance = tolerance;
      const Result<cooker::EncodedTree> tree = cooker::cook_as(mesh, CodecId::kWide4, options);
      ASSERT_EQ(tree.ok(), moved < tolerance) << moved << " of " << tolerance;
      if (!tree) continue;
      EXPECT_LE(tree->geometry.max_vertex_error, tolerance);
      EXPECT_GT(tree->geometry.max_vertex_error, moved);
    }
  }
}

TEST(Grid, StoresOfEveryBitCountWhatF32Moved) {
  SourceMesh mesh = test::torus(40, 30);
  mesh.moved_by_f32 = 0.25;
  for (const GeometryId store : {GeometryId::kExact, GeometryId::kArrays, GeometryId::kExternal}) {
    CookOptions options;
    options.geometry = store;
    const cooker::EncodedTree tree = test::require(cooker::cook_as(mesh, CodecId::kWide8, options));
    EXPECT_EQ(tree.geometry.max_vertex_error, store == GeometryId::kExternal ? 0 : 0.25);
  }
}

SourceMesh triangle_of(std::initializer_list<float> corners) {
  SourceMesh mesh;
  mesh.positions.f32 = corners;
  mesh.faces = {{{0, 1, 2, cooker::kNoCorner}}};
  return mesh;
}

// Half a step on every axis, the farthest that a vertex can move, is more than vertices do move.
TEST(Grid, ToleranceIsOfVerticesAsTheyMoveNotOfTheWorstCase) {
  const auto step_for = [](const SourceMesh& mesh, double tolerance) {
    const std::array meshes{&mesh};
    return test::require(cooker::choose_grid(meshes, {.tolerance = tolerance})).step_exponent;
  };
  // The worst case of a step of 2^-4 is 0.055, and of one of 2^-3 0.11.
  EXPECT_EQ(step_for(triangle_of({0, 0, 0, 8.125f, 0, 0, 0, 8.0625f, 0}), 0.1), -3);
  EXPECT_EQ(step_for(triangle_of({0, 0, 0, 8, 0, 0, 0.0625f, 8.0625f, 0.0625f}), 0.1), -4);
  // Whole numbers stay where they are up to a step of 1; none is 3 steps of 2.
  EXPECT_EQ(step_for(triangle_of({0, 0, 0, 8, 0, 0, 0, 3, 0}), 0.1), 0);
  // A step of 2^3 is the whole extent, beyond which nothing becomes smaller.
  EXPECT_EQ(step_for(triangle_of({0, 0, 0, 8, 0, 0, 0, 8, 0}), 0.1), 3);
}

// Each mesh alone could have a coarser grid than both together.
TEST(Grid, ToleranceIsOfAllMeshesThatShareTheGrid) {
  const SourceMesh coarse = triangle_of({0, 0, 0, 8, 0, 0, 0, 8, 0});
  const SourceMesh fine = triangle_of({0, 0, 0, 8.0625f, 8.0625f, 8.0625f, 0, 8, 0});
  const std::array meshes{&coarse, &fine};
  EXPECT_EQ(test::require(cooker::choose_grid(meshes, {.tolerance = 0.1})).step_exponent, -4);
  const Eigen::AlignedBox3d bounds = cooker::bounds_of(fine);
  const cooker::Grid grid = test::require(cooker::choose_grid(bounds, {.tolerance = 0.1}));
  std::vector<cooker::MeshOnGrid> apart = {{&coarse, bounds, grid, 0.1}};
  cooker::coarsen_together(apart);
  EXPECT_EQ(apart[0].grid.step_exponent, 3);
  apart = {{&coarse, bounds, grid, 0.1, -2}};
  cooker::coarsen_together(apart);
  EXPECT_EQ(apart[0].grid.step_exponent, -2);
}

// ilogb of what is no length is no exponent: differences from it overflow.
TEST(Grid, ToleranceThatIsNoLengthIsRefused) {
  const SourceMesh mesh = test::torus(8, 6);
  CookOptions options = on_grid(8);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double tolerance : {std::nan(""), 0.0, -1.0, kInfinity, -kInfinity}) {
    options.grid.tolerance = tolerance;
    EXPECT_EQ(cooker::cook_as(mesh, CodecId::kWide8, options).code(), Errc::kMeshUnsupported)
        << tolerance;
  }
  options.grid.tolerance = std::numeric_limits<double>::min();
  EXPECT_EQ(cooker::cook_as(mesh, CodecId::kWide8, options).code(), Errc::kMeshUnsupported);
  SourceMesh small = mesh;
  for (float& x : small.positions.f32) x *= 0x1p-20f;
  options.grid.tolerance = std::numeric_limits<double>::max();
  const test::CookedTree cooked = test::cook_tree(small, CodecId::kWide8, options);
  for (const auto& [face, corners] : decoded_faces(cooked.tree)) {
    for (const Eigen::Vector3d& corner : corners) EXPECT_EQ(corner, corners[0]) << face;
  }
}

TEST(Grid, KeepsAndCountsFacesThatCollapse) {
  SourceMesh mesh = test::torus(200, 150);
  const cooker::CookedTree cooked = test::require(cooker::cook_mesh(mesh, [] {
    CookOptions options = on_grid(8);
    options.codec = CodecId::kWide8;
    return options;
  }()));
  EXPECT_GT(cooked.collapsed, 1000u);
  EXPECT_EQ(cooked.tree.face_count, mesh.faces.size());
  EXPECT_EQ(cooked.tree.degenerate_count, cooked.collapsed);  // a torus has none of its own
}

TEST(Grid, CountsAllAsCollapsedOnAGridThatIsFarLargerThanTheMesh) {
  const SourceMesh mesh = test::torus(8, 6);
  CookOptions options = on_grid(8);
  options.grid.tolerance = 1e250;
  options.codec = CodecId::kWide8;
  const cooker::CookedTree cooked = test::require(cooker::cook_mesh(mesh, options));
  EXPECT_EQ(cooked.collapsed, mesh.triangle_count());
}

// Far from zero compared with its size, tiny, huge, flat, a single point.
TEST(Grid, AnySizeAndPlace) {
  const SourceMesh sphere = test::sphere(12, 16);
  struct Case {
    double scale;
    Eigen::Vector3d shift;
  };
  for (const Case& at : {Case{1e-30, {0, 0, 0}}, Case{1e30, {0, 0, 0}}, Case{1, {1e9, -1e12, 3}},
                         Case{1e-280, {0, 0, 0}}, Case{5e307, {0, 0, 0}}, Case{0, {1, 2, 3}}}) {
    SourceMesh mesh = sphere;
    mesh.positions = {cooker::Precision::kF64, {}, {}};
    for (std::size_t i = 0; i < sphere.positions.size(); ++i) {
      const Eigen::Vector3d p = sphere.positions[i] * at.scale + at.shift;
      mesh.positions.f64.insert(mesh.positions.f64.end(), {p[0], p[1], p[2]});
    }
    const test::CookedTree cooked = test::cook_tree(mesh, CodecId::kWide4, on_grid(20));
    const auto faces = decoded_faces(cooked.tree);
    const double allowed = std::max(std::ldexp(2 * at.scale, -20), 1e-15 * at.shift.norm());
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
      for (std::size_t c = 0; c < faces.at(f).size(); ++c) {
        const Eigen::Vector3d source = mesh.positions[mesh.faces[f].corner[c]];
        ASSERT_LE((faces.at(f)[c] / 2 - source / 2).cwiseAbs().maxCoeff(), allowed);
      }
    }
  }
}

TEST(Grid, HasTheStepThatIsRequested) {
  const Eigen::AlignedBox3d bounds(Eigen::Vector3d::Constant(-3), Eigen::Vector3d::Constant(5));
  for (const int step : {-27, -20, 0, 9}) {
    EXPECT_EQ(test::require(cooker::choose_grid(bounds, {.step_exponent = step})).step_exponent,
              step);
  }
  // An extent of 2^3: 30 bits are steps of 2^-27.
  const auto finer = cooker::choose_grid(bounds, {.step_exponent = -28});
  EXPECT_EQ(finer.code(), Errc::kMeshUnsupported);
  EXPECT_NE(finer.error().detail.find("a step of 2^-28 needs a grid of 31 bits"), std::string::npos)
      << finer.error().detail;
  // Found by a newcomer: what is possible was told as a tolerance, which is another option.
  EXPECT_TRUE(finer.error().detail.ends_with("at most 30 are possible, a step of 2^-27"))
      << finer.error().detail;
}

// Two meshes that touch along an irrational line, cooked into one grid, still share their vertices.
TEST(Grid, WhatTouchesStillTouches) {
  SourceMesh left = test::terrain(12, 5);
  for (float& x : left.positions.f32) x *= 0.7310585f;
  SourceMesh right = left;
  const Eigen::AlignedBox3d bounds = cooker::bounds_of(left);
  for (std::size_t i = 0; i < right.positions.f32.size(); i += 3) {
    right.positions.f32[i] = static_cast<float>(2 * bounds.max()[0]) - right.positions.f32[i];
  }
  Eigen::AlignedBox3d scene = bounds;
  scene.extend(cooker::bounds_of(right));
  CookOptions options = on_grid(12);
  const cooker::Grid grid = test::require(cooker::choose_grid(scene, options.grid));
  options.codec = CodecId::kWide8;
  const std::vector<cooker::EncodedTree> trees = {
      test::require(cooker::cook_mesh(left, options, grid)).tree,
      test::require(cooker::cook_mesh(right, options, grid)).tree};
  const std::vector<std::byte> bytes = cooker::serialize(trees);
  const File file = test::require(File::open(Bytes(bytes)));
  const Tree a = test::require(Tree::bind(file, 0));
  const Tree b = test::require(Tree::bind(file, 1));
  std::size_t shared = 0;
  const auto of_b = decoded_faces(b);
  for (const auto& [face, corners] : decoded_faces(a)) {
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const double source = left.positions[left.faces[face].corner[c]][0];
      if (source != bounds.max()[0]) continue;
      ASSERT_EQ(corners[c], of_b.at(face)[c]);
      ++shared;
    }
  }
  EXPECT_GT(shared, 12u);
  EXPECT_TRUE(first_contact(a, Pose::Identity(), b, Pose::Identity()).has_value());
}

}  // namespace
}  // namespace boxtree
