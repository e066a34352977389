// SPDX-License-Identifier: MIT
// What answers say beyond which face: nothing, errors, points and normals, and the way back to the
// triangle; and traversals of the application's own.
#include <array>
#include <cfenv>
#include <cmath>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "cooker/write/file_writer.h"
#include "tests/support/cooked.h"
#include "tests/support/float_state.h"
#include "tests/support/infinity.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/scenes.h"

namespace boxtree {
namespace {

using cooker::SourceMesh;

using test::kInfinity;

class Answers : public testing::TestWithParam<test::Encoding> {};

Eigen::Vector3d corner_of(const SourceMesh& mesh, std::uint32_t vertex) {
  return mesh.positions[vertex];
}

TEST(QueryResult, AMissCannotBeReadAsAHit) {
  const test::CookedTree cooked = test::cook_tree(test::sphere(8, 8), CodecId::kWide8);
  const RayResult miss = closest_hit(cooked.tree, {{0, 0, 10}, {0, 0, 1}});
  EXPECT_TRUE(miss.ok());
  EXPECT_FALSE(miss);
  EXPECT_EQ(miss->t, kInfinity);
  EXPECT_EQ(miss->face.id, kNoFaceId);
  EXPECT_EQ(miss->face.index, kNoFaceId);

  const RayResult error = closest_hit(cooked.tree, {{0, 0, 10}, {0, 0, 0}});
  EXPECT_FALSE(error.ok());
  EXPECT_FALSE(error);
  EXPECT_EQ(error.code(), Errc::kInvalidQuery);
  EXPECT_EQ(error->t, kInfinity);

  const PointResult far = closest_point(cooked.tree, {100, 0, 0}, 1.0);
  EXPECT_TRUE(far.ok());
  EXPECT_FALSE(far);
  EXPECT_EQ(far->distance, kInfinity);
}

// Point and normal against the triangle that the hit names, in plain arithmetic.
TEST_P(Answers, AHitHasItsPointAndNormal) {
  for (const SourceMesh& mesh : {test::torus(20, 12), test::city(8, 3), test::soup(300, 5)}) {
    const test::CookedTree cooked = test::cook_tree(mesh, GetParam());
    const Eigen::AlignedBox3d bounds = cooked.tree.bounds();
    std::mt19937_64 random(21);
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto around = [&] { return Eigen::Vector3d(unit(random), unit(random), unit(random)); };
    int hits = 0;
    for (int i = 0; i < 500; ++i) {
      const Eigen::Vector3d from =
          bounds.center() + 2 * around().cwiseProduct(bounds.sizes() + Eigen::Vector3d::Ones());
      const Ray ray{from, bounds.center() + around().cwiseProduct(bounds.sizes()) / 2 - from};
      const RayResult hit = closest_hit(cooked.tree, ray);
      ASSERT_TRUE(hit.ok());
      if (!hit) continue;
      ++hits;
      const Triangle triangle = test::require(cooked.tree.triangle(hit->face, hit->triangle));
      const auto& [a, b, c] = triangle.corner;
      const double size = bounds.sizes().maxCoeff() + from.cwiseAbs().maxCoeff();
      const Eigen::Vector3d by_weights = (1 - hit->u - hit->v) * a + hit->u * b + hit->v * c;
      ASSERT_LT((hit->point - by_weights).norm(), 1e-14 * size);
      // A sliver may lie far along the ray for a rounding of its own.
      const Eigen::Vector3d cross = (b - a).cross(c - a);
      const double sine =
          std::abs(cross.dot(ray.direction)) / (cross.norm() * ray.direction.norm() + 1e-300);
      if (sine > 1e-3) {
        ASSERT_LT((hit->point - (from + hit->t * ray.direction)).norm(), 1e-10 * size);
        ASSERT_LT((hit->normal - cross.normalized()).norm(), 1e-6);
      }
      ASSERT_NEAR(hit->normal.norm(), 1, 1e-14);
    }
    EXPECT_GT(hits, 20) << mesh.name;
  }
}

// Every triangle of every face, as the source has it; on a grid within its error.
TEST_P(Answers, LeadToTheirTriangles) {
  for (const SourceMesh& mesh : {test::city(6, 2), test::duplicates(5), test::sphere(9, 9)}) {
    const test::CookedTree cooked = test::cook_tree(mesh, GetParam());
    const double allowed =
        GetParam().geometry == GeometryId::kGrid ? 1e-3 * cooked.tree.bounds().sizes().norm() : 0;
    std::uint32_t triangles = 0;
    std::set<std::uint32_t> ids;
    for (std::uint32_t index = 0; index < cooked.tree.face_count(); ++index) {
      // Any answer that names the face: a sphere around its first corner.
      FaceRef named;
      named.index = index;
      const Result<Triangle> first = cooked.tree.triangle(named);
      ASSERT_TRUE(first.ok());
      static_cast<void>(test::require(
          overlap_sphere(cooked.tree, first->corner[0], allowed + 1e-9, [&](const FaceRef& face) {
            if (face.index == index) named.id = face.id;
            return true;
          })));
      ASSERT_NE(named.id, kNoFaceId);
      ids.insert(named.id);
      const cooker::Face& face = mesh.faces[named.id];
      const std::uint32_t halves = face.is_quad() ? 2 : 1;
      for (std::uint32_t half = 0; half < halves; ++half) {
        const Triangle got = test::require(cooked.tree.triangle(named, half));
        const std::array<std::size_t, 3> corners = {0, 1 + half, 2 + half};
        for (std::size_t k = 0; k < 3; ++k) {
          ASSERT_LE(
              (got.corner[k] - corner_of(mesh, face.corner[corners[k]])).cwiseAbs().maxCoeff(),
              allowed);
        }
        ++triangles;
      }
      EXPECT_EQ(cooked.tree.triangle(named, halves).code(), Errc::kInvalidQuery);
    }
    EXPECT_EQ(triangles, cooked.tree.triangle_count());
    EXPECT_EQ(ids.size(), mesh.faces.size());
    FaceRef none;
    EXPECT_EQ(cooked.tree.triangle(none).code(), Errc::kInvalidQuery);
    none.index = cooked.tree.face_count();
    EXPECT_EQ(cooked.tree.triangle(none).code(), Errc::kInvalidQuery);
  }
}

// With the test of overlap_box as its own, a traversal finds what overlap_box does.
TEST_P(Answers, OwnTraversalsFindWhatQueriesFind) {
  const test::CookedTree cooked = test::cook_tree(test::torus(24, 16), GetParam());
  const Eigen::AlignedBox3d box(Eigen::Vector3d(0.2, -0.4, -0.5), Eigen::Vector3d(1.5, 0.6, 0.5));
  std::set<std::uint32_t> expected;
  static_cast<void>(test::require(overlap_box(
      cooked.tree, box, [&](const FaceRef& face) { return expected.insert(face.id).second; })));
  ASSERT_GT(expected.size(), 10u);

  std::uint32_t seen = 0;
  std::set<std::pair<std::uint32_t, std::uint32_t>> once;
  std::set<std::uint32_t> found;
  const Result<Visit> visit = traverse(
      cooked.tree, [&](const Eigen::AlignedBox3d& node) { return node.intersects(box); },
      [&](const LeafTriangle& leaf) {
        ++seen;
        EXPECT_TRUE(once.insert({leaf.face.index, leaf.half}).second);
        const Triangle same = test::require(cooked.tree.triangle(leaf.face, leaf.half));
        for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(same.corner[k], leaf.triangle.corner[k]);
        found.insert(leaf.face.id);
        return true;
      });
  ASSERT_TRUE(visit.ok());
  EXPECT_EQ(*visit, Visit::kComplete);
  for (const std::uint32_t id : expected) EXPECT_TRUE(found.contains(id));

  // The whole tree; and no more than is allowed.
  std::uint32_t all = 0;
  const auto everything = [](const Eigen::AlignedBox3d&) { return true; };
  const auto count = [&](const LeafTriangle&) { return ++all > 0; };
  EXPECT_TRUE(traverse(cooked.tree, everything, count).ok());
  EXPECT_EQ(all, cooked.tree.triangle_count());
  EXPECT_LT(seen, all);
  EXPECT_EQ(traverse(cooked.tree, everything, count, {1}).code(), Errc::kWorkLimit);
  const auto stop = [](const LeafTriangle&) { return false; };
  EXPECT_EQ(*traverse(cooked.tree, everything, stop), Visit::kStopped);
}

std::uint32_t g_told = 0;
bool tell(const FaceRef& /*face*/) {
  return ++g_told > 0;
}

// Polygons that import split have parts of one number, in another order in each codec. Rays at a
// corner that two parts share, whose weights tell the parts apart, and points on the edge.
TEST_P(Answers, OfPartsOfAFaceAreThoseOfEveryCodec) {
  constexpr std::uint32_t kPolygons = 500;
  SourceMesh mesh;
  std::mt19937 random(33);
  std::uniform_real_distribution<float> unit(-1, 1);
  for (std::uint32_t i = 0; i < kPolygons; ++i) {
    const float at[3] = {10 * unit(random), 10 * unit(random), 10 * unit(random)};
    for (int corner = 0; corner < 4; ++corner) {
      for (const float x : at) mesh.positions.f32.push_back(x + unit(random));
    }
    mesh.faces.push_back({{4 * i, 4 * i + 1, 4 * i + 2, cooker::kNoCorner}});
    mesh.faces.push_back({{4 * i, 4 * i + 2, 4 * i + 3, cooker::kNoCorner}});
    mesh.face_ids.insert(mesh.face_ids.end(), {i, i});
  }
  const test::CookedTree cooked = test::cook_tree(mesh, GetParam());
  const test::CookedTree plain = test::cook_tree(mesh, {CodecId::kPlainF32, GetParam().geometry});
  int hits = 0;
  for (std::uint32_t i = 0; i < kPolygons; ++i) {
    // As it is decoded: the same from all trees.
    const Eigen::Vector3d shared = closest_point(plain.tree, corner_of(mesh, 4 * i + 2))->point;
    for (const Eigen::Vector3d& from : {Eigen::Vector3d(0, 0, 40), Eigen::Vector3d(30, 2, 1)}) {
      const Ray ray{shared + from, -from};
      const RayResult hit = closest_hit(cooked.tree, ray), other = closest_hit(plain.tree, ray);
      ASSERT_EQ(hit.has_value(), other.has_value());
      hits += hit.has_value() ? 1 : 0;
      ASSERT_EQ(hit->face.id, other->face.id);
      ASSERT_EQ(hit->t, other->t);
      ASSERT_EQ(hit->u, other->u);
      ASSERT_EQ(hit->v, other->v);
    }
    const Eigen::Vector3d middle =
        0.25 * corner_of(mesh, 4 * i) + 0.75 * corner_of(mesh, 4 * i + 2);
    const PointResult near = closest_point(cooked.tree, middle);
    const PointResult other = closest_point(plain.tree, middle);
    ASSERT_EQ(near->distance, other->distance);
    ASSERT_EQ(near->point, other->point);
  }
  EXPECT_GT(hits, 500);
}

// Found by a newcomer: -0 is equal to 0, but not in what is printed or divided by.
TEST_P(Answers, ARayThatBeginsOnAFaceHitsItAtZeroNotAtMinusZero) {
  SourceMesh mesh;
  mesh.positions.f32 = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  mesh.faces = {{{0, 1, 2, cooker::kNoCorner}}};
  const test::CookedTree cooked = test::cook_tree(mesh, GetParam());
  cooker::SceneParts parts;
  parts.instances.emplace_back();
  const test::CookedScene placed = test::cook_scene({mesh}, parts, {GetParam().codec});
  const Scene scene = test::require(Scene::bind(placed.file));
  std::size_t hits = 0;
  const auto check = [&](const auto& hit) {
    if (!hit) return;
    ++hits;
    EXPECT_EQ(hit->t, 0);
    EXPECT_FALSE(std::signbit(hit->t));
    EXPECT_FALSE(std::signbit(hit->u) || std::signbit(hit->v));
  };
  for (const double z : {0.0, -0.0}) {
    for (const double direction : {-1.0, 1.0}) {
      for (const Eigen::Vector3d& origin : {Eigen::Vector3d(0.25, 0.125, z),
                                            Eigen::Vector3d(0.5, 0, z), Eigen::Vector3d(0, 0, z)}) {
        const Ray ray{origin, {0.1, 0.2, direction}};
        check(closest_hit(cooked.tree, ray));
        check(any_hit(cooked.tree, ray));
        check(closest_hit(scene, ray));
      }
    }
  }
  EXPECT_GT(hits, 18u);
}

TEST(Visitors, CanBeFreeFunctions) {
  const test::CookedTree cooked = test::cook_tree(test::sphere(8, 8), CodecId::kWide8);
  g_told = 0;
  EXPECT_TRUE(overlap_sphere(cooked.tree, {0, 0, 0}, 10, tell).ok());
  EXPECT_EQ(g_told, cooked.tree.face_count());
}

TEST(Bind, ATreeIsTakenOnlyWhereThereIsOne) {
  const test::CookedScene scene =
      test::cook_scene({test::sphere(6, 6)}, test::random_parts(2, 1, 0, 1, 3));
  EXPECT_EQ(Tree::bind(scene.file).error().message(),
            "tree_index: the file holds a scene: bind that, or a tree by its number; trees: 1");
  EXPECT_TRUE(Tree::bind(scene.file, 0).ok());

  const cooker::EncodedTree one =
      test::require(cooker::cook_as(test::sphere(6, 6), CodecId::kWide8));
  const std::vector<cooker::EncodedTree> two = {one, one};
  const std::vector<std::byte> bytes = cooker::serialize(two);
  const File file = test::require(File::open(Bytes(bytes)));
  const Result<Tree> tree = Tree::bind(file);
  EXPECT_EQ(tree.code(), Errc::kTreeIndex);
  EXPECT_NE(tree.error().detail.find("2 trees"), std::string::npos);
  EXPECT_TRUE(Tree::bind(file, 1).ok());
  EXPECT_EQ(Tree::bind(file, 2).code(), Errc::kTreeIndex);
}

// As queries do: triangles and bounds are the same bits whatever rounding the caller has set.
TEST(Triangles, DoNotDependOnTheFloatStateOfTheCaller) {
  SourceMesh mesh = test::torus(12, 8);
  mesh.positions.precision = cooker::Precision::kF64;
  for (const float x : mesh.positions.f32) mesh.positions.f64.push_back(x / 3.0 + 1000.1);
  mesh.positions.f32.clear();
  const test::CookedTree cooked = test::cook_tree(mesh, CodecId::kPackedF64);
  const test::CookedScene placed =
      test::cook_scene({test::torus(12, 8)}, test::random_parts(5, 1, 1, 1, 7));
  const Scene scene = test::require(Scene::bind(placed.file));
  const auto corners = [&] {
    std::vector<Eigen::Vector3d> all = {cooked.tree.bounds().min(), cooked.tree.bounds().max()};
    for (std::uint32_t index = 0; index < cooked.tree.face_count(); ++index) {
      const FaceRef face{kNoFaceId, index};
      const Triangle alone = test::require(cooked.tree.triangle(face));
      const Triangle in_world = test::require(scene.triangle({index % 5, face}));
      all.insert(all.end(), alone.corner.begin(), alone.corner.end());
      all.insert(all.end(), in_world.corner.begin(), in_world.corner.end());
    }
    return all;
  };
  const std::vector<Eigen::Vector3d> expected = corners();
  const test::RoundingMode<FE_UPWARD> upward;
  const std::vector<Eigen::Vector3d> found = corners();
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(found[i], expected[i]) << i;
}

TEST(Tree, SaysWhatItIs) {
  const SourceMesh mesh = test::city(5, 1);
  const test::CookedTree cooked = test::cook_tree(mesh, CodecId::kWide4);
  EXPECT_EQ(cooked.tree.codec_name(), "wide4");
  EXPECT_EQ(cooked.tree.face_count(), mesh.faces.size());
  EXPECT_FALSE(cooked.tree.empty());
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    EXPECT_TRUE(cooked.tree.bounds().contains(corner_of(mesh, v)));
  }
  Tree copy = cooked.tree;
  copy = cooked.tree;
  EXPECT_EQ(copy.codec_name(), "wide4");
  EXPECT_TRUE(closest_point(copy, {0, 0, 0}));
}

INSTANTIATE_TEST_SUITE_P(Encodings, Answers, testing::ValuesIn(test::all_encodings()),
                         test::encoding_name);

}  // namespace
}  // namespace boxtree
