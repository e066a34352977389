// SPDX-License-Identifier: MIT
// Scenes of real files: what is placed is what import_mesh flattens.
#include <map>

#include "cooker/import/source_scene.h"
#include "placed_triangles.h"
#include "temp_files.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

void expect_scene(const SourceScene& scene) {
  ASSERT_FALSE(scene.instances.empty());
  std::vector<bool> placed(scene.meshes.size(), false);
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const SceneInstance& instance = scene.instances[i];
    ASSERT_LT(instance.mesh, scene.meshes.size());
    placed[instance.mesh] = true;
    EXPECT_EQ(instance.id, i);
    EXPECT_TRUE(instance.pose.matrix().allFinite());
  }
  std::vector<bool> used(scene.materials.size(), false);
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    EXPECT_TRUE(placed[i]);
    const SceneMesh& mesh = scene.meshes[i];
    ASSERT_FALSE(mesh.mesh.faces.empty());
    EXPECT_LT(mesh.mesh.face_id(mesh.mesh.faces.size() - 1), mesh.source_faces);
    EXPECT_EQ(mesh.materials.empty(), scene.materials.empty());
    for (std::size_t k = 0; k < mesh.materials.size(); ++k) {
      const FaceRun& run = mesh.materials[k];
      ASSERT_LT(run.number, scene.materials.size());
      used[run.number] = true;
      EXPECT_LT(run.first_face, mesh.source_faces);
      if (k == 0) {
        EXPECT_EQ(run.first_face, 0u);
      } else {
        EXPECT_GT(run.first_face, mesh.materials[k - 1].first_face);
        EXPECT_NE(run.number, mesh.materials[k - 1].number);
      }
    }
  }
  for (std::size_t i = 0; i < used.size(); ++i) EXPECT_TRUE(used[i]) << scene.materials[i];
}

struct Sizes {
  std::size_t instances, meshes, triangles, triangles_placed;
  bool operator==(const Sizes&) const = default;
};

std::ostream& operator<<(std::ostream& out, const Sizes& sizes) {
  return out << sizes.instances << " instances of " << sizes.meshes << " meshes, "
             << sizes.triangles << " triangles, placed " << sizes.triangles_placed;
}

Sizes sizes_of(const SourceScene& scene) {
  Sizes sizes{scene.instances.size(), scene.meshes.size(), 0, 0};
  for (const SceneMesh& mesh : scene.meshes) sizes.triangles += mesh.mesh.triangle_count();
  for (const SceneInstance& instance : scene.instances) {
    sizes.triangles_placed += scene.meshes[instance.mesh].mesh.triangle_count();
  }
  return sizes;
}

void expect_sizes(const std::string& name, const Sizes& expected) {
  const fs::path file = fs::path(ASSIMP_MODELS) / name;
  if (!fs::exists(file)) GTEST_SKIP() << file << " is not there (package assimp-testmodels)";
  const Result<SourceScene> scene = import_scene(file);
  ASSERT_TRUE(scene.ok()) << scene.error().message();
  expect_scene(*scene);
  EXPECT_EQ(sizes_of(*scene), expected);
  const Result<Imported> flat = import_mesh(file);
  ASSERT_TRUE(flat.ok()) << flat.error().message();
  EXPECT_EQ(placed_triangles(*scene), placed_triangles(flat->mesh));
  const Result<ImportedFile> fitting = import_file(file);
  ASSERT_TRUE(fitting.ok());
  EXPECT_TRUE(std::holds_alternative<SourceScene>(*fitting));
}

TEST(ImportSceneModelsTest, CylinderEngine) {
  expect_sizes("glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb", {67, 29, 75730, 121496});
}

// The same compressed by Draco, which assimp reads, with fewer faces.
TEST(ImportSceneModelsTest, CylinderEngineOfDraco) {
  expect_sizes("glTF2/draco/2CylinderEngine.gltf", {67, 29, 65311, 110336});
}

TEST(ImportSceneModelsTest, MilkTruck) {
  expect_sizes("glTF/CesiumMilkTruck/CesiumMilkTruck.gltf", {3, 2, 2856, 3624});
}

// Of the three small cubes two are green and one is red.
TEST(ImportSceneModelsTest, MirroredFbxCubes) {
  expect_sizes("FBX/cubes_with_mirroring_and_pivot.fbx", {4, 3, 408, 420});
}

TEST(ImportSceneModelsTest, MaterialsOfFbx) {
  const fs::path path = fs::path(ASSIMP_MODELS) / "FBX/spider.fbx";
  if (!fs::exists(path)) GTEST_SKIP() << path << " is not there (package assimp-testmodels)";
  const Result<SourceScene> spider = import_scene(path);
  ASSERT_TRUE(spider.ok()) << spider.error().message();
  EXPECT_EQ(spider->materials,
            (std::vector<std::string>{"BeinTex", "Skin", "Augentex", "HLeibTex"}));
}

// Each glTF 2 file: the primitives that the numbers name are those of the mesh that has them.
TEST(ImportSceneModelsTest, PrimitivesOfEveryFile) {
  const fs::path folder = fs::path(ASSIMP_MODELS) / "glTF2";
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not there (package assimp-testmodels)";
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const fs::path ending = entry.path().extension();
    if (ending != ".gltf" && ending != ".glb") continue;
    SCOPED_TRACE(entry.path());
    if (!import_scene(entry.path()).ok()) continue;
    ImportOptions options;
    options.user_data = kPrimitives;
    const Result<SourceScene> scene = import_scene(entry.path(), options);
    ASSERT_TRUE(scene.ok()) << scene.error().message();
    for (const SceneMesh& mesh : scene->meshes) {
      ASSERT_FALSE(mesh.user_data.empty());
      for (const FaceRun& run : mesh.user_data) {
        ASSERT_LT(run.number, scene->report.primitives.size());
        const std::string& name = scene->report.primitives[run.number];
        EXPECT_TRUE(name.starts_with(mesh.mesh.name) || name.starts_with("mesh "))
            << name << " of " << mesh.mesh.name;
      }
    }
    ++files;
  }
  EXPECT_GT(files, 20u);
}

// Each file: import_scene has what import_mesh has, or says no with the same words.
TEST(ImportSceneModelsTest, EveryFile) {
  const fs::path folder = ASSIMP_MODELS;
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not there (package assimp-testmodels)";
  std::map<std::string, std::size_t> count;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    SCOPED_TRACE(entry.path());
    const Result<SourceScene> scene = import_scene(entry.path());
    const Result<Imported> flat = import_mesh(entry.path());
    EXPECT_EQ(scene.code(), flat.code());
    if (!scene.ok() || !flat.ok()) continue;
    expect_scene(*scene);
    EXPECT_EQ(scene->report.content_hash, flat->report.content_hash);
    EXPECT_EQ(sizes_of(*scene).triangles_placed, flat->mesh.triangle_count());
    ++count["read"];
    if (scene->instances.size() > 1) ++count["several instances"];
    if (scene->instances.size() > scene->meshes.size()) ++count["shared meshes"];
  }
  EXPECT_GT(count["read"], 300u);
  EXPECT_GT(count["several instances"], 60u);
  // Not glTF2/IncorrectVertexArrays/Cube.gltf, which has 35 corners of triangles and is refused.
  EXPECT_GE(count["shared meshes"], 29u);
}

}  // namespace
}  // namespace boxtree::cooker
