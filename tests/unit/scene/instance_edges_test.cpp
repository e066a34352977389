// SPDX-License-Identifier: MIT
// Edges where instances meet: every bit of a scene is that of brute force over all placed faces;
// what hits and contacts say; instances that move; bytes that are corrupt.
#include "format/instance_edges.h"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "cooker/proof/proof.h"
#include "runtime/file/open_file.h"
#include "runtime/primitive/predicates.h"
#include "runtime/scene/bound_scene.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/active_edges_reference.h"
#include "tests/support/cooked.h"
#include "tests/support/require.h"
#include "tests/support/scenes.h"

namespace boxtree {
namespace {

using cooker::PlacedTree;
using cooker::SceneParts;
using cooker::SourceMesh;
using test::CookedScene;
using test::require;

constexpr double kDegrees = 20;

// The square from -1 to 1 in x and y, of 4 x 4 cells, some of them quads.
SourceMesh tile(unsigned seed) {
  SourceMesh mesh;
  mesh.name = "tile";
  std::mt19937 random(seed);
  for (int y = 0; y <= 4; ++y) {
    for (int x = 0; x <= 4; ++x) {
      for (const float number : {static_cast<float>(x - 2) / 2, static_cast<float>(y - 2) / 2, 0.F})
        mesh.positions.f32.push_back(number);
    }
  }
  for (unsigned y = 0; y < 4; ++y) {
    for (unsigned x = 0; x < 4; ++x) {
      const unsigned a = 5 * y + x, b = a + 1, c = b + 5, d = a + 5;
      const auto kind = static_cast<unsigned>(random() % 3);
      if (kind == 0) {
        mesh.faces.push_back({{a, b, c, d}});
      } else if (kind == 1) {
        mesh.faces.push_back({{a, b, c, cooker::kNoCorner}});
        mesh.faces.push_back({{c, d, a, cooker::kNoCorner}});
      } else {
        mesh.faces.push_back({{a, b, d, cooker::kNoCorner}});
        mesh.faces.push_back({{b, c, d, cooker::kNoCorner}});
      }
    }
  }
  return mesh;
}

// Tiles on the faces of a lattice, either side up, mirrored, some of them ramps that rise from it.
SceneParts lattice(unsigned seed, std::uint32_t count, std::uint32_t trees) {
  std::mt19937 random(seed);
  SceneParts parts;
  for (std::uint32_t i = 0; i < count; ++i) {
    PlacedTree placed;
    placed.tree = i % trees;
    placed.id = i;
    placed.moves = random() % 8 == 0;
    Eigen::Matrix3d linear = Eigen::Matrix3d::Zero();
    const auto turn = static_cast<unsigned>(random() % 3);
    for (unsigned k = 0; k < 3; ++k) {
      const auto row = static_cast<Eigen::Index>((k + turn) % 3);
      linear(row, static_cast<Eigen::Index>(k)) = random() % 2 == 0 ? 1 : -1;
    }
    Eigen::Vector3d at;
    for (Eigen::Index k = 0; k < 3; ++k) at[k] = random() % 2 == 0 ? 0 : 2;
    if (random() % 4 == 0) {
      const double slope = random() % 2 == 0 ? 0.25 : 0.5;  // 14 and 27 degrees
      Eigen::Matrix3d shear = Eigen::Matrix3d::Identity();
      shear(2, 0) = random() % 2 == 0 ? slope : -slope;
      at += linear.col(2) * slope;
      linear = linear * shear;
    }
    at += linear.col(0) + linear.col(1);
    placed.pose.linear() = linear;
    placed.pose.translation() = at;
    parts.instances.push_back(placed);
  }
  return parts;
}

cooker::CookOptions with_active_edges(GeometryId geometry = GeometryId::kExact) {
  cooker::CookOptions options;
  options.active_edges = kDegrees;
  options.geometry = geometry;
  options.grid.bits = 12;
  return options;
}

CookedScene cook(unsigned seed,
                 const test::Encoding& encoding = {CodecId::kWide8, GeometryId::kExact}) {
  return test::cook_scene({tile(1), tile(2)}, lattice(seed, 14, 2), {encoding.codec},
                          with_active_edges(encoding.geometry));
}

// Bits of a half by those of its face.
std::uint32_t edges_of_half(std::uint32_t of_face, bool is_quad, std::uint32_t half) {
  if (!is_quad) return of_face;
  return half == 0 ? of_face & 3u : (of_face >> 2 & 1u) << 1 | (of_face >> 3 & 1u) << 2;
}

template <class Visit>
void for_each_triangle(const CookedScene& cooked, const Scene& scene, Visit visit) {
  for (std::uint32_t i = 0; i < scene.instance_count(); ++i) {
    const std::uint32_t number = require(scene.info(i)).tree;
    const BoundTree& tree = BoundTree::of(scene.trees()[number]);
    for (std::uint32_t f = 0; f < tree.face_count(); ++f) {
      const FaceRef face{tree.face_id(f), f};
      const bool is_quad = cooked.meshes[number].faces[face.id].is_quad();
      for (std::uint32_t half = 0; half < (is_quad ? 2u : 1u); ++half) {
        visit(SceneFace{i, face}, half, is_quad);
      }
    }
  }
}

std::size_t section_bytes(const CookedScene& cooked) {
  return OpenFile::of(cooked.file).section(SectionKind::kInstanceEdges).size();
}

TEST(InstanceEdges, AreThoseOfBruteForceOverAllPlacedFaces) {
  const std::vector<test::Encoding> encodings = {{CodecId::kWide8, GeometryId::kExact},
                                                 {CodecId::kWide4, GeometryId::kGrid},
                                                 {CodecId::kPlainF32, GeometryId::kArrays},
                                                 {CodecId::kPackedF16, GeometryId::kGrid}};
  std::size_t inactive = 0;
  for (unsigned seed = 0; seed < 24; ++seed) {
    const CookedScene cooked = cook(seed, encodings[seed % encodings.size()]);
    EXPECT_TRUE(cooker::verify_file(cooked.file).empty());
    const Scene scene = require(Scene::bind(cooked.file));
    const auto expected =
        test::active_edges_by_brute_force(cooked.meshes, cooked.parts.instances, kDegrees);
    for_each_triangle(cooked, scene, [&](const SceneFace& face, std::uint32_t half, bool is_quad) {
      const std::uint32_t id = require(scene.info(face.instance)).id;
      const std::uint32_t found = require(active_edges(scene, face, half));
      EXPECT_EQ(found, edges_of_half(expected[id][face.face.id], is_quad, half)) << seed;
      const Tree& tree = scene.trees()[require(scene.info(face.instance)).tree];
      if (found != require(active_edges(tree, face.face, half))) ++inactive;
    });
  }
  EXPECT_GT(inactive, 500u);
}

TEST(InstanceEdges, OfHitsAndContactsAreThoseOfTheInstance) {
  std::size_t edges = 0, inactive_borders = 0;
  for (unsigned seed = 0; seed < 24; ++seed) {
    const CookedScene cooked = cook(seed);
    const Scene scene = require(Scene::bind(cooked.file));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> anywhere(-1, 5);
    const auto compare = [&](const auto& hit) {
      const SceneFace face{hit.instance, hit.face};
      const std::uint32_t here = require(active_edges(scene, face, hit.triangle));
      const Tree& tree = scene.trees()[require(scene.info(hit.instance)).tree];
      const std::uint32_t of_tree = require(active_edges(tree, hit.face, hit.triangle));
      const auto edges_at = [](std::uint32_t corner) {
        return 1u << corner | 1u << (corner + 2) % 3;
      };
      const bool is_vertex = hit.feature == Feature::kVertex;
      const std::uint32_t bits = is_vertex ? edges_at(hit.feature_index) : 1u << hit.feature_index;
      bool is_active = hit.feature == Feature::kFace || (here & bits) != 0;
      // Corners 0 and 2 of a quad are in both its triangles, (0, 1, 2) and (0, 2, 3).
      const std::uint32_t number = require(scene.info(hit.instance)).tree;
      const std::uint32_t of_quad = hit.triangle == 0 ? hit.feature_index : 2 * hit.feature_index;
      if (is_vertex && cooked.meshes[number].faces[hit.face.id].is_quad() && of_quad % 2 == 0 &&
          of_quad <= 2) {
        const std::uint32_t other = 1 - hit.triangle;
        is_active = is_active || (require(active_edges(scene, face, other)) &
                                  edges_at(other == 0 ? of_quad : of_quad / 2)) != 0;
      }
      EXPECT_EQ(hit.is_active, is_active);
      edges += hit.feature != Feature::kFace ? 1 : 0;
      inactive_borders += !hit.is_active && (of_tree & bits) != 0 ? 1 : 0;
    };
    for (int i = 0; i < 300; ++i) {
      const Eigen::Vector3d at(anywhere(random), anywhere(random), anywhere(random));
      static_cast<void>(require(collide(scene, Sphere{at, 0.3}, [&](const SceneContact& contact) {
        compare(contact);
        return true;
      })));
      const Motion motion{Eigen::Vector3d(anywhere(random), anywhere(random), anywhere(random)) -
                          at};
      const SceneCastResult hit = cast_closest(scene, Sphere{at, 0.1}, motion);
      ASSERT_TRUE(hit.ok());
      if (hit) compare(*hit);
    }
  }
  EXPECT_GT(edges, 1000u);
  EXPECT_GT(inactive_borders, 50u);
}

// Four tiles in a row.
SceneParts row() {
  SceneParts parts;
  for (std::uint32_t i = 0; i < 4; ++i) {
    PlacedTree placed;
    placed.id = i;
    placed.pose.translation() = Eigen::Vector3d(2.0 * i, 0, 0);
    parts.instances.push_back(placed);
  }
  return parts;
}

TEST(InstanceEdges, OfWhatMovesAreThoseOfItsTree) {
  const CookedScene cooked =
      test::cook_scene({tile(1)}, row(), {CodecId::kWide8}, with_active_edges());
  Scene scene = require(Scene::bind(cooked.file));
  const auto differ = [&](std::uint32_t instance) {
    int count = 0;
    for_each_triangle(cooked, scene, [&](const SceneFace& face, std::uint32_t half, bool) {
      if (face.instance != instance) return;
      count += require(active_edges(scene, face, half)) !=
                       require(active_edges(scene.trees()[0], face.face, half))
                   ? 1
                   : 0;
    });
    return count;
  };
  std::vector<int> before;
  for (std::uint32_t i = 0; i < 4; ++i) before.push_back(differ(i));
  EXPECT_EQ(*std::min_element(before.begin(), before.end()), 4);
  EXPECT_EQ(*std::max_element(before.begin(), before.end()), 8);
  ASSERT_TRUE(scene.make_movable(2).ok());
  for (std::uint32_t i = 0; i < 4; ++i) EXPECT_EQ(differ(i), i == 2 ? 0 : before[i]);
  ASSERT_TRUE(scene.update(2, Pose::Identity()).ok());
  EXPECT_EQ(differ(2), 0);
  SceneOptions options;
  const std::vector<std::uint32_t> moving = {1};
  options.moving = moving;
  scene = require(Scene::bind(cooked.file, options));
  EXPECT_EQ(differ(1), 0);
  EXPECT_EQ(differ(2), before[2]);
  EXPECT_EQ(active_edges(scene, {4, {0, 0}}).code(), Errc::kInstanceIndex);
  EXPECT_EQ(active_edges(scene, {0, {0, 1u << 30}}).code(), Errc::kInvalidQuery);
}

// Both inner tiles of a row of four have one list.
TEST(InstanceEdges, TakeALineForEachFaceThatInstancesShare) {
  const CookedScene cooked =
      test::cook_scene({tile(1)}, row(), {CodecId::kWide8}, with_active_edges());
  EXPECT_EQ(cooked.parts.edge_lists.size(), 3u);
  EXPECT_EQ(section_bytes(cooked), 4 * sizeof(EdgeListRow) + (4 + 8 + 4) * 4);
  EXPECT_FALSE(test::entry_of(cooked.bytes, SectionKind::kInstanceEdges).is_required);
  SceneParts apart = row();
  for (PlacedTree& placed : apart.instances) placed.pose.translation() *= 2;
  EXPECT_EQ(
      section_bytes(test::cook_scene({tile(1)}, apart, {CodecId::kWide8}, with_active_edges())),
      0u);
  EXPECT_EQ(section_bytes(test::cook_scene({tile(1)}, row())), 0u) << "left out";
}

// Sections of a scene are in the order of their kinds, which the reader holds them to.
TEST(InstanceEdges, StandBesideMaterialsAndWhatWasLeftOut) {
  const SourceMesh mesh = tile(1);
  SceneParts parts = row();
  parts.materials = {"stone"};
  parts.tree_materials.push_back({{}, std::vector<std::uint32_t>(mesh.faces.size(), 0)});
  parts.left_out.push_back({Part::kNames, 0xffffffffu, 3, "names = false"});
  const CookedScene cooked =
      test::cook_scene({mesh}, parts, {CodecId::kWide8}, with_active_edges());
  EXPECT_GT(section_bytes(cooked), 0u);
  const Scene scene = require(Scene::bind(cooked.file));
  EXPECT_EQ(scene.material_name(0), "stone");
}

TEST(InstanceEdges, OfCopiesAreThoseOfTheirOriginals) {
  SourceMesh twice = tile(1);
  const std::size_t count = twice.faces.size();
  for (std::size_t i = 0; i < count; ++i) twice.faces.push_back(twice.faces[i]);
  const CookedScene cooked =
      test::cook_scene({twice}, row(), {CodecId::kWide8}, with_active_edges());
  const Scene scene = require(Scene::bind(cooked.file));
  const auto expected =
      test::active_edges_by_brute_force(cooked.meshes, cooked.parts.instances, kDegrees);
  for_each_triangle(cooked, scene, [&](const SceneFace& face, std::uint32_t half, bool is_quad) {
    const std::uint32_t id = require(scene.info(face.instance)).id;
    EXPECT_EQ(require(active_edges(scene, face, half)),
              edges_of_half(expected[id][face.face.id], is_quad, half));
  });
}

TEST(InstanceEdges, CorruptBytesAreFoundAndReadInside) {
  const CookedScene cooked = cook(3);
  const SectionEntry entry = test::entry_of(cooked.bytes, SectionKind::kInstanceEdges);
  std::size_t found = 0;
  for (std::size_t bit = 0; bit < entry.size * 8; ++bit) {
    std::vector<std::byte> bytes = cooked.bytes;
    bytes[entry.offset + bit / 8] ^= std::byte{1} << (bit % 8);
    test::repair_checksums(bytes);
    const File file = require(File::open(Bytes(bytes)));
    found += cooker::verify_file(file).empty() ? 0u : 1u;
    const Scene scene = require(Scene::bind(file));
    for_each_triangle(cooked, scene, [&](const SceneFace& face, std::uint32_t half, bool) {
      EXPECT_LE(require(active_edges(scene, face, half)), 7u);
    });
  }
  EXPECT_GT(found, entry.size * 4) << "of the bits of faces most";
  // A row for each instance at rest, then whole entries.
  EXPECT_TRUE(InstanceEdgesView::are_rows_inside(8 * 14, 14));
  EXPECT_TRUE(InstanceEdgesView::are_rows_inside(8 * 14 + 4, 14));
  EXPECT_FALSE(InstanceEdgesView::are_rows_inside(8 * 14 + 2, 14));
  EXPECT_FALSE(InstanceEdgesView::are_rows_inside(8 * 13, 14));
}

}  // namespace
}  // namespace boxtree
