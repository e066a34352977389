// SPDX-License-Identifier: MIT
// Materials of FBX files: faces in the order of the file, whatever assimp does to tell materials.
#include "cooker/import/fbx_materials.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <assimp/scene.h>

#include "cooker/import/source_scene.h"
#include "fbx_text.h"
#include "placed_triangles.h"
#include "temp_files.h"

namespace boxtree::cooker {
namespace {

using Runs = std::vector<std::array<std::uint32_t, 2>>;

Runs runs_of(const std::vector<FaceRun>& materials) {
  Runs runs;
  for (const FaceRun& run : materials) runs.push_back({run.first_face, run.number});
  return runs;
}

class FbxMaterials : public ImportTest {
 protected:
  // Of all instances, one after the other.
  static Runs flat_runs(const SourceScene& scene) {
    Runs runs;
    std::uint32_t first = 0;
    for (const SceneInstance& instance : scene.instances) {
      const SceneMesh& mesh = scene.meshes[instance.mesh];
      for (const FaceRun& run : mesh.materials) {
        const bool differs = runs.empty() || runs.back()[1] != run.number;
        if (differs) runs.push_back({first + run.first_face, run.number});
      }
      first += mesh.source_faces;
    }
    return runs;
  }

  SourceScene scene(const std::string& text) const {
    const std::filesystem::path path = write("ladder.fbx", text);
    Result<SourceScene> result = import_scene(path);
    EXPECT_TRUE(result.ok()) << result.error().message();
    if (!result.ok()) return {};
    const Result<Imported> flat = import_mesh(path);
    EXPECT_TRUE(flat.ok()) << flat.error().message();
    if (flat.ok()) {
      EXPECT_EQ(placed_triangles(*result), placed_triangles(flat->mesh));
      EXPECT_TRUE(flat->materials.names.empty()) << "none were wanted";
    }
    ImportOptions with_materials;
    with_materials.materials = true;
    const Result<Imported> flat_with = import_mesh(path, with_materials);
    EXPECT_TRUE(flat_with.ok()) << flat_with.error().message();
    if (flat_with.ok()) {
      EXPECT_EQ(flat_with->materials.names, result->materials);
      EXPECT_EQ(runs_of(flat_with->materials.runs), flat_runs(*result));
    }
    return std::move(result).value();
  }
};

TEST_F(FbxMaterials, FacesThatTakeTurnsStayInTheirOrder) {
  const SourceScene got =
      scene(fbx_text("0,1,5,-5,1,2,-7,1,6,-6,2,3,7,-7,3,7,-3", 17, "0,1,0,1,1", 5));
  ASSERT_EQ(got.meshes.size(), 1u);
  EXPECT_EQ(got.instances.size(), 2u);
  EXPECT_EQ(got.materials, (std::vector<std::string>{"stone", "glass"}));
  EXPECT_EQ(runs_of(got.meshes[0].materials), (Runs{{0, 0}, {1, 1}, {2, 0}, {3, 1}}));
  // The quad is first, as in the file.
  EXPECT_NE(got.meshes[0].mesh.faces[0].corner[3], kNoCorner);
}

TEST_F(FbxMaterials, OnlyFacesOfThreeCornersCount) {
  const SourceScene got = scene(fbx_text("0,1,-6,1,-3,5,6,-3,2,3,-8", 11, "1,0,1,0", 4));
  ASSERT_EQ(got.meshes.size(), 1u);
  EXPECT_EQ(got.meshes[0].source_faces, 3u);
  EXPECT_EQ(got.materials, (std::vector<std::string>{"glass", "stone"}));
  EXPECT_EQ(runs_of(got.meshes[0].materials), (Runs{{0, 0}, {2, 1}}));
}

TEST_F(FbxMaterials, OneMaterialIsOneRun) {
  const SourceScene got = scene(fbx_text("0,1,-6,1,2,-7", 6, "1,1", 2));
  ASSERT_EQ(got.meshes.size(), 1u);
  EXPECT_EQ(got.materials, std::vector<std::string>{"glass"});
  EXPECT_EQ(runs_of(got.meshes[0].materials), (Runs{{0, 0}}));
}

// Two faces of the same corners: whichever is taken for which, all are found.
TEST_F(FbxMaterials, EqualFacesOfTwoMaterials) {
  const SourceScene got = scene(fbx_text("0,1,-6,0,1,-6,1,2,-7", 9, "1,0,0", 3));
  ASSERT_EQ(got.meshes.size(), 1u);
  EXPECT_EQ(got.materials, (std::vector<std::string>{"glass", "stone"}));
  EXPECT_EQ(runs_of(got.meshes[0].materials), (Runs{{0, 0}, {1, 1}}));
}

TEST_F(FbxMaterials, FacesOfAnotherReadingAreNotGuessed) {
  const auto triangles = [](std::vector<float> heights, unsigned material) {
    auto mesh = std::make_unique<aiMesh>();
    mesh->mMaterialIndex = material;
    mesh->mNumFaces = static_cast<unsigned>(heights.size());
    mesh->mFaces = new aiFace[mesh->mNumFaces];
    mesh->mNumVertices = 3 * mesh->mNumFaces;
    mesh->mVertices = new aiVector3D[mesh->mNumVertices];
    for (unsigned f = 0; f < mesh->mNumFaces; ++f) {
      mesh->mFaces[f].mNumIndices = 3;
      mesh->mFaces[f].mIndices = new unsigned[3]{3 * f, 3 * f + 1, 3 * f + 2};
      for (unsigned c = 0; c < 3; ++c) {
        mesh->mVertices[3 * f + c] = {static_cast<float>(c), heights[f], 0};
      }
    }
    return mesh;
  };
  const auto scene_of = [](std::vector<std::unique_ptr<aiMesh>> meshes) {
    auto scene = std::make_unique<aiScene>();
    scene->mNumMeshes = static_cast<unsigned>(meshes.size());
    scene->mMeshes = new aiMesh*[scene->mNumMeshes];
    for (unsigned i = 0; i < scene->mNumMeshes; ++i) scene->mMeshes[i] = meshes[i].release();
    return scene;
  };
  const auto match = [&](std::vector<std::vector<float>> in_order,
                         std::vector<std::vector<float>> sorted) {
    std::vector<std::unique_ptr<aiMesh>> of_file, by_material;
    for (auto& heights : in_order) of_file.push_back(triangles(heights, 9));
    unsigned material = 0;
    for (auto& heights : sorted) by_material.push_back(triangles(heights, material++));
    const auto first = scene_of(std::move(of_file));
    const auto second = scene_of(std::move(by_material));
    std::vector<Runs> runs;
    for (const MeshMaterials& mesh : match_materials(*first, *second))
      runs.push_back(runs_of(mesh));
    return runs;
  };
  const Runs unknown = {{0, kNoMaterial}};
  EXPECT_EQ(match({{1, 2, 3}, {4}}, {{1, 3}, {2}, {4}}),
            (std::vector<Runs>{{{0, 0}, {1, 1}, {2, 0}}, {{0, 2}}}));
  // Other faces, or other numbers of them; and all that comes after those.
  EXPECT_EQ(match({{1, 2, 3}, {4}}, {{1, 5}, {2}, {4}}), (std::vector<Runs>{unknown, {{0, 2}}}));
  EXPECT_EQ(match({{1, 2, 3}, {4}}, {{1, 2}, {3, 4}}), (std::vector<Runs>{unknown, unknown}));
  EXPECT_EQ(match({{1, 2}, {4}}, {{1, 2}}), (std::vector<Runs>{{{0, 0}}, unknown}));
  // Faces 1, 1, 2 of materials 1, 0, 0 could be told, but not by looking at one face at a time.
  EXPECT_EQ(match({{1, 2, 1}}, {{1}, {1, 2}}), (std::vector<Runs>{unknown}));
}

}  // namespace
}  // namespace boxtree::cooker
