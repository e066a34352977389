// SPDX-License-Identifier: MIT
// Exported scenes against brute force over all placed triangles, and against what importing the
// file again makes of it.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "cooker/import/source_scene.h"
#include "exported.h"
#include "format/container.h"
#include "runtime/file/open_file.h"
#include "runtime/scene/bound_scene.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"
#include "viewer_files.h"

namespace boxtree::cooker {
namespace {

using test::ViewedPart;

/// Corners of triangles as coordinates, the least first, the sense of rotation kept; sorted.
using Corner = std::array<double, 3>;
using Triangles = std::vector<std::array<Corner, 3>>;

void append(Triangles& triangles, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
            const Eigen::Vector3d& c) {
  std::array<Corner, 3> corners;
  const std::array<Eigen::Vector3d, 3> points = {a, b, c};
  for (std::size_t i = 0; i < 3; ++i) corners[i] = {points[i][0], points[i][1], points[i][2]};
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  triangles.push_back(corners);
}

// Of the instance with an id, by brute force; those of a mirrored one keep their front.
Triangles expected_of(const std::vector<test::WorldTriangle>& world, const Scene& scene,
                      std::uint32_t id) {
  Triangles triangles;
  for (const test::WorldTriangle& placed : world) {
    if (placed.id != id) continue;
    const bool turns = test::require(scene.pose(placed.instance)).linear().determinant() < 0;
    const auto& corner = placed.triangle.corner;
    append(triangles, corner[0], corner[turns ? 2 : 1], corner[turns ? 1 : 2]);
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

// Of a part of a file, placed by nodes if there are any. A node that mirrors turns faces.
Triangles seen_of(const ViewedPart& part) {
  Pose pose = Pose::Identity();
  pose.matrix() = part.pose.matrix();
  const bool is_placed = pose.matrix() != Pose::Identity().matrix();
  const bool turns = pose.linear().determinant() < 0;
  Triangles triangles;
  for (const auto& face : part.elements) {
    const auto at = [&](std::size_t i) {
      const Eigen::Vector3d& vertex = part.vertices.at(face.at(i));
      return is_placed ? test::placed(pose, vertex) : vertex;
    };
    for (std::size_t i = 1; i + 1 < face.size(); ++i) {
      append(triangles, at(0), at(turns ? i + 1 : i), at(turns ? i : i + 1));
    }
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

ViewedPart as_part(const SourceMesh& mesh) {
  ViewedPart part;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    part.vertices.push_back(mesh.positions[v]);
  }
  for (const Face& face : mesh.faces) {
    part.elements.emplace_back(face.corner.begin(), face.corner.end() - (face.is_quad() ? 0 : 1));
  }
  return part;
}

double largest_difference(const Triangles& a, const Triangles& b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double largest = 0;
  for (std::size_t t = 0; t < a.size(); ++t) {
    for (std::size_t i = 0; i < 9; ++i) {
      largest = std::max(largest, std::abs(a[t][i / 3][i % 3] - b[t][i / 3][i % 3]));
    }
  }
  return largest;
}

std::filesystem::path export_as(const test::TempFolder& folder, const std::string& name,
                                const Scene& scene, const ExportOptions& options,
                                ExportReport* report = nullptr) {
  const std::filesystem::path path = folder.path() / name;
  ExportReport written = test::require(export_scene(scene, scene.trees(), path, options));
  EXPECT_EQ(written.bytes, std::filesystem::file_size(path));
  if (report != nullptr) *report = std::move(written);
  return path;
}

// Instances of closed meshes of triangles and of quads; every other is mirrored and sheared.
test::CookedScene random_scene(const std::vector<CodecId>& codecs = {CodecId::kWide8}) {
  std::vector<SourceMesh> meshes = {test::torus(8, 6), test::city(3, 1), test::soup(30, 3)};
  return test::cook_scene(std::move(meshes), test::random_parts(14, 3, 5, 2, 7), codecs);
}

// Poses whose every product is exact in any order: turned by right angles, scaled by powers of two,
// mirrored, moved.
test::CookedScene right_angled_scene() {
  std::vector<SourceMesh> meshes = {test::torus(8, 6), test::city(3, 1)};
  meshes[0].name = "ring";
  meshes[1].name = "town";
  SceneParts parts;
  const auto place = [&](const char* name, std::uint32_t tree, const Eigen::Vector3d& x,
                         const Eigen::Vector3d& y, const Eigen::Vector3d& z,
                         const Eigen::Vector3d& moved) {
    PlacedTree placed;
    placed.name = name;
    placed.tree = tree;
    placed.id = static_cast<std::uint32_t>(parts.instances.size());
    placed.pose.linear() << x, y, z;
    placed.pose.translation() = moved;
    parts.instances.push_back(placed);
  };
  place("still", 0, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0});
  place("moved", 1, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {20, -3, 0.5});
  place("turned", 0, {0, 2, 0}, {0, 0, 2}, {2, 0, 0}, {-9, 0, 0.25});
  place("mirrored", 0, {-1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 30, 0});
  place("stretched", 1, {0.5, 0, 0}, {0, 0, -4}, {0, -2, 0}, {0, 0, 50});
  return test::cook_scene(std::move(meshes), std::move(parts));
}

// The triangles of a scene as a viewer sees them.
struct Exported {
  std::vector<ViewedPart> obj;
  std::vector<ViewedPart> glb;
};

Exported exported(const test::TempFolder& folder, const Scene& scene) {
  return {test::read_viewer_file(export_as(folder, "out.obj", scene, triangles_only())),
          test::read_viewer_file(export_as(folder, "out.glb", scene, triangles_only()))};
}

TEST(ExportScene, EveryInstanceIsWhereBruteForcePutsIt) {
  const test::TempFolder folder;
  for (const CodecId codec : {CodecId::kWide8, CodecId::kPlainF16, CodecId::kDedup}) {
    const test::CookedScene cooked = random_scene({codec});
    const Scene scene = test::require(Scene::bind(cooked.file));
    const std::vector<test::WorldTriangle> world = test::world_triangles(cooked, scene);
    const auto [obj, glb] = exported(folder, scene);
    ASSERT_EQ(obj.size(), scene.instance_count());
    ASSERT_EQ(glb.size(), scene.instance_count());
    for (std::uint32_t id = 0; id < scene.instance_count(); ++id) {
      const std::string name = "instance " + std::to_string(id);
      SCOPED_TRACE(name);
      EXPECT_EQ(obj[id].object, name);
      EXPECT_EQ(glb[id].object, name);
      EXPECT_EQ(glb[id].name, name);
      const Triangles expected = expected_of(world, scene, id);
      EXPECT_EQ(seen_of(obj[id]), expected) << "to the last bit of f64";
      // A pose that shears is the product of two matrices, which rounds.
      const bool shears = id % 2 == 1;
      EXPECT_LE(largest_difference(seen_of(glb[id]), expected), shears ? 1e-13 : 0.0);
    }
  }
}

TEST(ExportScene, InstancesShareTheMeshOfTheirTree) {
  const test::TempFolder folder;
  const test::CookedScene cooked = random_scene();
  const Scene scene = test::require(Scene::bind(cooked.file));
  ExportReport report;
  ExportOptions options = everything();
  const auto path = export_as(folder, "out.glb", scene, options, &report);
  EXPECT_EQ(report.instances, 14u);
  EXPECT_EQ(report.placed_triangles, test::world_triangles(cooked, scene).size());
  std::size_t meshes = 0;
  for (std::size_t tree = 0; tree < report.trees.size(); ++tree) {
    meshes += 1 + report.trees[tree].boxes.size();
    EXPECT_EQ(report.trees[tree].instances, tree < 2 ? 5u : 4u);
  }
  const nlohmann::json json = test::glb_document(test::read_text(path));
  EXPECT_EQ(json["meshes"].size(), meshes);
  EXPECT_EQ(json["meshes"][0]["name"], "torus");
  EXPECT_EQ(json["meshes"][1]["name"], "torus level 0");
  std::map<std::size_t, std::set<std::size_t>> meshes_of_tree;
  for (const ViewedPart& part : test::read_viewer_file(path)) {
    const std::size_t id = std::stoul(part.object.substr(std::string("instance ").size()));
    if (part.name == part.object) meshes_of_tree[id % 3].insert(part.mesh);
    EXPECT_EQ(part.name.rfind(part.object, 0), 0u) << part.name;
  }
  ASSERT_EQ(meshes_of_tree.size(), 3u);
  for (const auto& [tree, used] : meshes_of_tree) EXPECT_EQ(used.size(), 1u);
}

TEST(ExportScene, ImportedAgainItIsTheSameScene) {
  const test::TempFolder folder;
  const test::CookedScene cooked = right_angled_scene();
  const Scene scene = test::require(Scene::bind(cooked.file));
  // With boxes, too: lines are no faces.
  const auto path = export_as(folder, "out.glb", scene, {});
  const ImportedFile file = test::require(import_file(path));
  ASSERT_TRUE(std::holds_alternative<SourceScene>(file));
  const auto& again = std::get<SourceScene>(file);
  ASSERT_EQ(again.meshes.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(again.meshes[i].mesh.name, cooked.meshes[i].name);
    EXPECT_EQ(triangles_of(again.meshes[i].mesh), triangles_of(cooked.meshes[i]));
  }
  ASSERT_EQ(again.instances.size(), cooked.parts.instances.size());
  for (std::size_t i = 0; i < again.instances.size(); ++i) {
    const PlacedTree& placed = cooked.parts.instances[i];
    EXPECT_EQ(again.instances[i].name, placed.name);
    EXPECT_EQ(again.instances[i].mesh, placed.tree);
    EXPECT_EQ(again.instances[i].pose.matrix(), placed.pose.matrix());
  }
}

TEST(ExportScene, ImportedAsOneMeshItIsTheSameInBothFormats) {
  const test::TempFolder folder;
  const test::CookedScene cooked = right_angled_scene();
  const Scene scene = test::require(Scene::bind(cooked.file));
  const std::vector<test::WorldTriangle> world = test::world_triangles(cooked, scene);
  Triangles expected;
  for (std::uint32_t id = 0; id < scene.instance_count(); ++id) {
    const Triangles some = expected_of(world, scene, id);
    expected.insert(expected.end(), some.begin(), some.end());
  }
  std::sort(expected.begin(), expected.end());
  for (const char* name : {"out.obj", "out.glb"}) {
    const SourceMesh mesh =
        imported(export_as(folder, name, scene, triangles_only()), Precision::kF64);
    EXPECT_EQ(seen_of(as_part(mesh)), expected) << name;
  }
}

// Readers that hold matrices in f32, as assimp does, keep what f32 can tell, shear included.
TEST(ExportScene, ImportedAgainShearedInstancesAreStillThere) {
  const test::TempFolder folder;
  const test::CookedScene cooked = random_scene();
  const Scene scene = test::require(Scene::bind(cooked.file));
  const std::vector<test::WorldTriangle> world = test::world_triangles(cooked, scene);
  const SourceScene again =
      test::require(import_scene(export_as(folder, "out.glb", scene, triangles_only())));
  ASSERT_EQ(again.instances.size(), 14u);
  for (std::uint32_t id = 0; id < 14; ++id) {
    const SceneInstance& instance = again.instances[id];
    EXPECT_EQ(instance.name, "instance " + std::to_string(id));
    std::size_t next = 0;
    const auto expect_next = [&](const SourceMesh& mesh, const std::array<std::uint32_t, 3>& face) {
      while (world.at(next).id != id) ++next;
      for (std::size_t i = 0; i < 3; ++i) {
        const Eigen::Vector3d seen = test::placed(instance.pose, mesh.positions[face[i]]);
        ASSERT_LT((seen - world[next].triangle.corner[i]).norm(), 1e-5);
      }
      ++next;
    };
    const SourceMesh& mesh = again.meshes[instance.mesh].mesh;
    for (const Face& face : mesh.faces) {
      ASSERT_FALSE(face.is_quad());
      expect_next(mesh, {face.corner[0], face.corner[1], face.corner[2]});
    }
  }
}

// Divergence: what is closed encloses the volume of its mesh times the determinant, and not minus
// that, whatever mirrors it. Solid boxes as well.
TEST(ExportScene, FacesOfMirroredInstancesKeepTheirFront) {
  const test::TempFolder folder;
  const test::CookedScene cooked =
      test::cook_scene({test::torus(8, 6)}, test::random_parts(10, 1, 0, 1, 3));
  const Scene scene = test::require(Scene::bind(cooked.file));
  const auto volume_of = [](const Triangles& triangles) {
    double six_volumes = 0;
    for (const auto& [a, b, c] : triangles) {
      const Eigen::Vector3d q(b.data());
      six_volumes += Eigen::Vector3d(a.data()).dot(q.cross(Eigen::Vector3d(c.data())));
    }
    return six_volumes / 6;
  };
  const double torus = volume_of(seen_of(as_part(cooked.meshes[0])));
  ASSERT_GT(torus, 0);
  const Tree& tree = scene.trees()[0];
  const double box = BoundTree::of(tree).to_object(BoundTree::of(tree).root().box).volume();
  ExportOptions options;
  options.levels = {{0, 0}};
  options.solid_boxes = true;
  for (const char* name : {"out.obj", "out.glb"}) {
    std::size_t mirrored = 0;
    for (const ViewedPart& part : test::read_viewer_file(export_as(folder, name, scene, options))) {
      SCOPED_TRACE(std::string(name) + ", " + part.name);
      const std::size_t id = std::stoul(part.object.substr(std::string("instance ").size()));
      const double determinant = cooked.parts.instances[id].pose.linear().determinant();
      mirrored += determinant < 0 ? 1u : 0u;
      const bool is_box = part.name.find("level") != std::string::npos;
      EXPECT_NEAR(volume_of(seen_of(part)) / (std::abs(determinant) * (is_box ? box : torus)), 1,
                  1e-6);
    }
    EXPECT_EQ(mirrored, 10u) << "half of the instances, two parts each";
  }
}

TEST(ExportScene, BoxesTurnWithTheirInstance) {
  const test::TempFolder folder;
  const test::CookedScene cooked = random_scene();
  const Scene scene = test::require(Scene::bind(cooked.file));
  ExportOptions options;
  options.triangles = false;
  options.levels = {{0, 0}};
  for (const char* name : {"out.obj", "out.glb"}) {
    const std::vector<ViewedPart> parts =
        test::read_viewer_file(export_as(folder, name, scene, options));
    ASSERT_EQ(parts.size(), 14u);
    for (std::uint32_t id = 0; id < 14; ++id) {
      const ViewedPart& part = parts[id];
      SCOPED_TRACE(std::string(name) + ", " + part.name);
      ASSERT_EQ(part.vertices.size(), 8u);
      EXPECT_TRUE(part.has_lines);
      const PlacedTree& placed = cooked.parts.instances[id];
      const Tree& tree = scene.trees()[placed.tree];
      const Eigen::AlignedBox3d box = BoundTree::of(tree).to_object(BoundTree::of(tree).root().box);
      for (unsigned i = 0; i < 8; ++i) {
        const Eigen::Vector3d corner =
            test::placed(placed.pose, box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));
        EXPECT_LT((part.pose * part.vertices[i] - corner).norm(), 1e-5);
      }
    }
  }
}

// Far from the origin of its tree f32 tells half a unit; the pose takes the tree back and makes it
// a thousand times larger.
TEST(ExportScene, FarTreesKeepTheirDigits) {
  const test::TempFolder folder;
  SceneParts parts;
  parts.instances.resize(2);
  parts.instances[1].id = 1;
  parts.instances[1].pose.linear().diagonal().setConstant(1000);
  parts.instances[1].pose.translation() = -1000 * Eigen::Vector3d(6.4e6, -6.4e6, 1.5e6);
  const test::CookedScene cooked =
      test::cook_scene({far_away(test::torus(20, 12), 1e-3, {6.4e6, -6.4e6, 1.5e6})}, parts);
  const Scene scene = test::require(Scene::bind(cooked.file));
  const std::vector<test::WorldTriangle> world = test::world_triangles(cooked, scene);
  const auto [obj, glb] = exported(folder, scene);
  for (std::uint32_t id = 0; id < 2; ++id) {
    EXPECT_EQ(seen_of(obj[id]), expected_of(world, scene, id));
  }
  // As of one tree, 1e-7 (FarFromTheOriginPrecisionSurvives), times a thousand; f64 itself rounds
  // to 1e-6 there.
  std::size_t next = 0;
  ASSERT_EQ(world.size(), glb[0].elements.size() + glb[1].elements.size());
  while (world[next].id != 1) ++next;
  for (const auto& face : glb[1].elements) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d seen = glb[1].pose * glb[1].vertices[face[i]];
      EXPECT_LT((seen - world[next].triangle.corner[i]).norm(), 2e-4);
    }
    ++next;
  }
}

TEST(ExportScene, InstancesComeByIdAndTreesWithoutAnyNotAtAll) {
  const test::TempFolder folder;
  SceneParts parts;
  for (const std::uint32_t id : {5u, 3u, 9u}) {
    PlacedTree placed;
    placed.tree = id == 5 ? 2 : 0;
    placed.id = id;
    placed.name = id == 9 ? "" : "id " + std::to_string(id);
    placed.pose.translation()[0] = id;
    parts.instances.push_back(placed);
  }
  const test::CookedScene cooked =
      test::cook_scene({test::torus(8, 6), test::city(3, 1), test::soup(30, 3)}, parts);
  const Scene scene = test::require(Scene::bind(cooked.file));
  std::string unnamed;
  for (std::uint32_t i = 0; i < 3; ++i) {
    if (test::require(scene.info(i)).id == 9) unnamed = "instance " + std::to_string(i);
  }
  for (const char* name : {"out.obj", "out.glb"}) {
    ExportReport report;
    const auto path = export_as(folder, name, scene, triangles_only(), &report);
    std::vector<std::string> objects;
    for (const ViewedPart& part : test::read_viewer_file(path)) objects.push_back(part.object);
    EXPECT_EQ(objects, (std::vector<std::string>{"id 3", "id 5", unnamed}));
    ASSERT_EQ(report.trees.size(), 2u);
    EXPECT_EQ(report.trees[0].name, "torus");
    EXPECT_EQ(report.trees[0].instances, 2u);
    EXPECT_EQ(report.trees[1].name, "soup");
  }
}

TEST(ExportScene, PosesThatAreNoneAreRefused) {
  const test::TempFolder folder;
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e308}) {
    test::CookedScene cooked = test::cook_scene({far_away(test::torus(8, 6), 100, {0, 0, 0})},
                                                test::random_parts(3, 1, 0, 1, 1));
    const Scene scene = test::require(Scene::bind(cooked.file));
    ASSERT_EQ(BoundScene::of(scene).record().pose_bytes, sizeof(double));
    const Bytes poses = OpenFile::of(cooked.file).section(SectionKind::kPoses);
    std::byte* const first = cooked.bytes.data() + (poses.data() - cooked.bytes.data());
    std::memcpy(first, &bad, sizeof(bad));
    for (const char* name : {"out.obj", "out.glb"}) {
      const auto result = export_scene(scene, scene.trees(), folder.path() / name, {});
      EXPECT_EQ(result.code(), Errc::kRecordInvalid);
      EXPECT_NE(result.error().detail.find("instance "), std::string::npos);
    }
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace boxtree::cooker
