// SPDX-License-Identifier: MIT
// Active edges end to end: every bit of a file in every encoding is that of brute force; what hits
// and contacts say of the feature that they touch; bytes that are corrupt.
#include "cooker/encode/active_edges.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <tuple>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "cooker/import/mesh_arrays.h"
#include "cooker/proof/proof.h"
#include "format/active_edges.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/active_edges_reference.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"

namespace boxtree {
namespace {

using cooker::SourceMesh;
using test::require;

constexpr double kDegrees = 12;

cooker::CookOptions with_active_edges(GeometryId geometry = GeometryId::kExact) {
  cooker::CookOptions options;
  options.active_edges = kDegrees;
  options.geometry = geometry;
  options.grid.bits = 24;
  return options;
}

// What active_edges() has to say of a half of a face.
std::uint32_t expected_edges(std::uint32_t of_face, bool is_quad, std::uint32_t half) {
  if (!is_quad) return of_face;
  const auto bit = [&](std::uint32_t edge) { return of_face >> edge & 1u; };
  return half == 0 ? bit(0) | bit(1) << 1 : bit(2) << 1 | bit(3) << 2;
}

void expect_edges_of_brute_force(const SourceMesh& mesh, const Tree& tree) {
  const std::vector<std::uint8_t> active = test::active_edges_by_brute_force(mesh, kDegrees);
  std::uint32_t compared = 0;
  const auto compare = [&](const FaceRef& ref) {
    const bool is_quad = mesh.faces[ref.id].is_quad();
    for (std::uint32_t half = 0; half < (is_quad ? 2u : 1u); ++half) {
      const Triangle triangle = require(tree.triangle(ref, half));
      const std::uint32_t found = require(active_edges(tree, ref, half));
      if (is_degenerate(triangle)) {
        EXPECT_EQ(found, expected_edges(is_quad ? 0xfu : 7u, is_quad, half));
      } else {
        EXPECT_EQ(found, expected_edges(active[ref.id], is_quad, half)) << mesh.name << ref.id;
      }
      ++compared;
    }
    return true;
  };
  ASSERT_TRUE(overlap_box(tree, tree.bounds(), compare).ok());
  EXPECT_EQ(compared, tree.triangle_count());
}

class OfEncoding : public testing::TestWithParam<test::Encoding> {};

TEST_P(OfEncoding, EachBitIsThatOfBruteForce) {
  for (const SourceMesh& mesh : test::all_kinds()) {
    // A grid may merge what is that small.
    const bool is_small = mesh.name.find("tiny") != std::string::npos ||
                          mesh.name.find("sliver") != std::string::npos;
    if (GetParam().geometry == GeometryId::kGrid && is_small) continue;
    const test::CookedTree cooked =
        test::cook_tree(mesh, GetParam().codec, with_active_edges(GetParam().geometry));
    ASSERT_TRUE(cooked.tree.has_active_edges());
    EXPECT_TRUE(cooker::verify_file(cooked.file).empty()) << mesh.name;
    expect_edges_of_brute_force(mesh, cooked.tree);
  }
}

INSTANTIATE_TEST_SUITE_P(Encodings, OfEncoding, testing::ValuesIn(test::all_encodings()),
                         test::encoding_name);

TEST(ActiveEdges, OfTheApplicationsArraysAreLookedUpInThem) {
  const SourceMesh mesh = test::terrain(20, 3);
  for (const CodecId codec : {CodecId::kWide8, CodecId::kPlainF32}) {
    BindOptions bind;
    bind.mesh = cooker::arrays_of(mesh);
    const test::CookedTree cooked =
        test::cook_tree(mesh, codec, with_active_edges(GeometryId::kExternal), bind);
    expect_edges_of_brute_force(mesh, cooked.tree);
  }
}

TEST(ActiveEdges, OfOneFaceAloneAreStoredByFace) {
  SourceMesh mesh = test::terrain(12, 4);
  const std::size_t count = mesh.faces.size();
  for (std::size_t f = 0; f < count; ++f) {
    const auto [a, b, c, d] = mesh.faces[f].corner;
    mesh.faces.push_back({{a, c, b, d}});
  }
  const test::CookedTree cooked = test::cook_tree(mesh, CodecId::kWide8, with_active_edges());
  EXPECT_EQ(BoundTree::of(cooked.tree).active_edges().header().is_by_face, 1);
  expect_edges_of_brute_force(mesh, cooked.tree);
}

TEST(ActiveEdges, TakeAtMostAQuarterOfAByteATriangle) {
  const SourceMesh mesh = test::terrain(200, 5);  // of its edges a good part is active
  const auto cooked = require(cooker::cook_as(mesh, CodecId::kWide8, with_active_edges()));
  const double each = static_cast<double>(cooked.geometry.active_edges.size()) /
                      static_cast<double>(mesh.triangle_count());
  EXPECT_LE(each, 0.25);
  EXPECT_GE(each, 0.05) << "it has some";
}

TEST(ActiveEdges, AreAllOfThemWhereTheyWereLeftOut) {
  const SourceMesh mesh = test::terrain(8, 3);
  const test::CookedTree cooked = test::cook_tree(mesh, CodecId::kWide8);
  EXPECT_FALSE(cooked.tree.has_active_edges());
  EXPECT_EQ(require(active_edges(cooked.tree, {0, 0})), 7u);
  BindOptions options;
  options.require_active_edges = true;
  EXPECT_EQ(Tree::bind(cooked.file, options).code(), Errc::kPartLeftOut);
  const test::CookedTree with = test::cook_tree(mesh, CodecId::kWide8, with_active_edges());
  EXPECT_TRUE(Tree::bind(with.file, options).ok());
  EXPECT_EQ(active_edges(with.tree, {0, 1u << 30}).code(), Errc::kInvalidQuery);
  EXPECT_EQ(active_edges(with.tree, {0, 0}, 1).code(), Errc::kInvalidQuery);
}

// A roof: both slopes, whose ridge is active, over a floor that goes on flat.
SourceMesh roof() {
  SourceMesh mesh;
  mesh.positions.f32 = {0, -2, 1, 0, 2,  1, -2, -2, 0, -2, 2,  0, 2, -2, 0,
                        2, 2,  0, 4, -2, 0, 4,  2,  0, 6,  -2, 0, 6, 2,  0};
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.faces.push_back({{a, b, c, cooker::kNoCorner}});
  };
  add(0, 1, 3), add(0, 3, 2), add(0, 4, 5), add(0, 5, 1);
  add(4, 6, 7), add(4, 7, 5), add(6, 8, 9), add(6, 9, 7);
  return mesh;
}

// Each contact and hit names the edge or vertex that it touches, and says whether it is active.
template <class Hit>
void expect_named_feature(const Tree& tree, const Hit& hit) {
  const Triangle triangle = require(tree.triangle(hit.face, hit.triangle));
  const std::uint32_t edges = require(active_edges(tree, hit.face, hit.triangle));
  const Eigen::Vector3d a = triangle.corner[hit.feature_index];
  const Eigen::Vector3d b = triangle.corner[(hit.feature_index + 1u) % 3];
  const std::uint32_t before = (hit.feature_index + 2u) % 3;
  const Eigen::Vector3d n =
      (triangle.corner[1] - triangle.corner[0]).cross(triangle.corner[2] - triangle.corner[0]);
  EXPECT_NEAR(std::abs(n.normalized().dot(hit.face_normal)), 1, 1e-12);
  EXPECT_GE(hit.face_normal.dot(hit.normal), -1e-12);
  switch (hit.feature) {
    case Feature::kFace:
      EXPECT_EQ(hit.feature_index, 0);
      EXPECT_TRUE(hit.is_active);
      break;
    case Feature::kEdge:
      EXPECT_NEAR((hit.point - a).cross(b - a).norm() / (b - a).norm(), 0, 1e-9);
      EXPECT_EQ(hit.is_active, (edges >> hit.feature_index & 1u) != 0);
      break;
    case Feature::kVertex:
      EXPECT_NEAR((hit.point - a).norm(), 0, 1e-9);
      EXPECT_EQ(hit.is_active, ((edges >> hit.feature_index | edges >> before) & 1u) != 0);
      break;
  }
  const Eigen::Vector3d resolved = resolved_normal(hit, Eigen::Vector3d(1, 0, -1));
  EXPECT_EQ(resolved, hit.is_active ? hit.normal : hit.face_normal);
}

TEST(ActiveEdges, HitsAndContactsNameTheFeatureAndWhetherItIsActive) {
  const test::CookedTree cooked = test::cook_tree(roof(), CodecId::kWide8, with_active_edges());
  const Tree& tree = cooked.tree;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> along(-3, 7), across(-2.5, 2.5), up(0, 1.2);
  std::map<std::pair<Feature, bool>, int> seen;
  for (int i = 0; i < 3000; ++i) {
    const Sphere sphere{{along(random), across(random), up(random)}, 0.3};
    static_cast<void>(require(collide(tree, sphere, [&](const Contact& contact) {
      expect_named_feature(tree, contact);
      ++seen[{contact.feature, contact.is_active}];
      return true;
    })));
    const Motion motion{{along(random), across(random), -1}, 5};
    const CastResult hit = cast_closest(tree, sphere, motion);
    ASSERT_TRUE(hit.ok());
    if (hit) expect_named_feature(tree, *hit);
  }
  EXPECT_EQ(seen.size(), 4u);  // a face is always active, and all vertices are on a boundary
}

// A quad's corner on its diagonal has an edge of each of its triangles: both say the same of it.
TEST(ActiveEdges, ACornerOfAQuadIsActiveByEitherOfItsTriangles) {
  SourceMesh mesh;
  mesh.name = "quad and triangle";
  mesh.positions.f32 = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, -1, 0, 0, -1, 1, 0};
  // The quad goes on beyond its edge at x = 0, so of its corner 0 the edge to (1, 0, 0) alone is
  // active, which is the first triangle's, and of corner 3 the edge to (1, 1, 0), the second one's.
  mesh.faces = {{{0, 1, 2, 3}}, {{4, 0, 3, 5}}};
  cooker::CookOptions options = with_active_edges();
  const test::CookedTree cooked = test::cook_tree(mesh, CodecId::kWide8, options);
  for (const Eigen::Vector3d& center : {Eigen::Vector3d(0, -0.3, 0.3), Eigen::Vector3d(0, 1.3, 0.3),
                                        Eigen::Vector3d(1.2, 1.2, 0.3)}) {
    int vertices = 0;
    const auto look = [&](const Contact& contact) {
      EXPECT_EQ(contact.feature, Feature::kVertex);
      EXPECT_TRUE(contact.is_active)
          << center.transpose() << " face " << contact.face.id << " half " << contact.triangle;
      ++vertices;
      return true;
    };
    ASSERT_TRUE(collide(cooked.tree, Sphere{center, 0.5}, look).ok());
    EXPECT_GE(vertices, 2);
  }
}

// A wall on the diagonal of a floor's quad: its edge there is found by the same ends, and active.
TEST(ActiveEdges, TheDiagonalOfAQuadIsNotEvenWhereAnotherFaceHasAnActiveEdge) {
  SourceMesh mesh;
  mesh.name = "wall";
  mesh.positions.f32 = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1};
  mesh.faces = {{{0, 1, 2, 3}}, {{0, 2, 4, cooker::kNoCorner}}};
  for (const test::Encoding& encoding : test::all_encodings()) {
    SCOPED_TRACE(codec_name(encoding.codec));
    const test::CookedTree cooked =
        test::cook_tree(mesh, encoding.codec, with_active_edges(encoding.geometry));
    expect_edges_of_brute_force(mesh, cooked.tree);
    int on_diagonal = 0, on_wall = 0;
    ASSERT_TRUE(collide(cooked.tree, Sphere{{0.5, 0.5, -0.05}, 0.1}, [&](const Contact& contact) {
                  EXPECT_EQ(contact.feature, Feature::kEdge);
                  EXPECT_EQ(contact.is_active, contact.face.id == 1);
                  (contact.face.id == 1 ? on_wall : on_diagonal) += 1;
                  return true;
                }).ok());
    EXPECT_EQ(on_diagonal, 2);
    EXPECT_EQ(on_wall, 1);
  }
}

TEST(ActiveEdges, TheRidgeOfARoofKeepsItsNormalAndAFlatEdgeDoesNot) {
  const test::CookedTree cooked = test::cook_tree(roof(), CodecId::kWide4, with_active_edges());
  const Motion down{{0, 0, -1}, 10};
  const CastResult ridge = cast_closest(cooked.tree, Sphere{{0, 0.3, 3}, 0.5}, down);
  ASSERT_TRUE(ridge.ok() && bool{ridge});
  EXPECT_EQ(ridge->feature, Feature::kEdge);
  EXPECT_TRUE(ridge->is_active);
  EXPECT_NEAR(resolved_normal(*ridge, down.direction)[2], 1, 1e-9);
  // Sunk into the floor beside the edge between coplanar triangles.
  int inactive = 0;
  static_cast<void>(
      require(collide(cooked.tree, Sphere{{3.9, 0.3, 0.28}, 0.3}, [&](const Contact& contact) {
        if (contact.feature == Feature::kFace) return true;
        ++inactive;
        EXPECT_FALSE(contact.is_active);
        EXPECT_LT(contact.normal[2], 0.99);
        EXPECT_EQ(resolved_normal(contact, {1, 0, 0}), Eigen::Vector3d(0, 0, 1));
        return true;
      })));
  EXPECT_GE(inactive, 1);
}

TEST(ActiveEdges, AnInactiveNormalInThePlaneOfTheFaceIsTurnedAgainstTheVelocity) {
  CastHit hit;
  hit.normal = {-1, 0, 0};
  hit.face_normal = {0, 0, 1};
  hit.is_active = false;
  EXPECT_EQ(resolved_normal(hit, {1, 0, -1}), Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(resolved_normal(hit, {1, 0, 1}), Eigen::Vector3d(0, 0, -1));
  EXPECT_EQ(resolved_normal(hit, {0, 0, 0}), Eigen::Vector3d(0, 0, 1));
  hit.is_active = true;
  EXPECT_EQ(resolved_normal(hit, {1, 0, 1}), hit.normal);
  hit.is_active = false;
  hit.face_normal = {0, 0, 0};  // without an area
  EXPECT_EQ(resolved_normal(hit, {1, 0, 1}), hit.normal);
}

TEST(ActiveEdges, CorruptBytesAreFoundAndReadInside) {
  const std::vector<std::byte> whole =
      test::cook_bytes(test::terrain(6, 3), CodecId::kWide8, with_active_edges());
  const SectionEntry entry = test::entry_of(whole, SectionKind::kActiveEdges);
  EXPECT_FALSE(entry.is_required);
  const auto count = load<ActiveEdgesHeader>(whole.data() + entry.offset).start_count;
  ASSERT_GT(count, 0u);
  std::size_t found = 0;
  for (std::size_t bit = 0; bit < entry.size * 8; ++bit) {
    std::vector<std::byte> bytes = whole;
    bytes[entry.offset + bit / 8] ^= std::byte{1} << (bit % 8);
    test::repair_checksums(bytes);
    const File file = require(File::open(Bytes(bytes)));
    found += cooker::verify_file(file).empty() ? 0u : 1u;
    const Result<Tree> tree = Tree::bind(file);
    if (!tree) {
      EXPECT_EQ(tree.code(), Errc::kSectionSize);
      continue;
    }
    for (std::uint32_t face = 0; face < tree->face_count(); ++face) {
      EXPECT_LE(require(active_edges(*tree, {0, face})), 7u);
    }
  }
  EXPECT_GT(found, 24u);  // what is zero, codes, counts
}

}  // namespace
}  // namespace boxtree
