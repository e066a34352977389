// SPDX-License-Identifier: MIT
// The hash of a scene depends on all that is taken of it; and a file of which assimp's reader takes
// memory that it has not set, or that lies behind its array, is an error.
#include "cooker/import/scene_hash.h"

#include <set>
#include <string>

#include <assimp/scene.h>
#include <gtest/gtest.h>

#include "cooker/import/import.h"
#include "temp_files.h"

namespace boxtree::cooker {
namespace {

// A triangle in a node below the root; the scene owns it.
void fill(aiScene& scene) {
  auto* const mesh = new aiMesh;
  mesh->mNumVertices = 3;
  mesh->mVertices = new aiVector3D[3];
  mesh->mVertices[1].x = 1;
  mesh->mVertices[2].y = 1;
  mesh->mNumFaces = 1;
  mesh->mFaces = new aiFace[1];
  mesh->mFaces[0].mNumIndices = 3;
  mesh->mFaces[0].mIndices = new unsigned int[3]{0, 1, 2};
  scene.mNumMeshes = 1;
  scene.mMeshes = new aiMesh* [1] { mesh };
  auto* const node = new aiNode;
  node->mNumMeshes = 1;
  node->mMeshes = new unsigned int[1]{0};
  scene.mRootNode = new aiNode;
  scene.mRootNode->addChildren(1, const_cast<aiNode**>(&node));
}

TEST(SceneHash, DependsOnAllThatIsTaken) {
  aiScene scene;
  fill(scene);
  aiScene same;
  fill(same);
  EXPECT_EQ(geometry_hash(scene), geometry_hash(same));
  std::set<std::uint64_t> hashes = {geometry_hash(scene)};
  const auto expect_new = [&] { EXPECT_TRUE(hashes.insert(geometry_hash(scene)).second); };
  scene.mMeshes[0]->mVertices[2].z = 1;
  expect_new();
  scene.mMeshes[0]->mFaces[0].mIndices[2] = 1;
  expect_new();
  scene.mMeshes[0]->mFaces[0].mNumIndices = 2;
  expect_new();
  scene.mRootNode->mTransformation.a4 = 1;
  expect_new();
  scene.mRootNode->mChildren[0]->mTransformation.a4 = 1;
  expect_new();
  scene.mRootNode->mChildren[0]->mNumMeshes = 0;
  expect_new();
}

class UnsetMemory : public ImportTest {};

std::string ogre(int vertex) {
  return R"(<mesh><submeshes><submesh material="a" usesharedvertices="false" )"
         R"(use32bitindexes="false" operationtype="triangle_list"><faces count="2">)"
         R"(<face v1="0" v2="2" v3="1"/><face v1="0" v2="1" v3=")" +
         std::to_string(vertex) +
         R"("/></faces><geometry vertexcount="4"><vertexbuffer positions="true">)"
         R"(<vertex><position x="0" y="0" z="0"/></vertex><vertex><position x="1" y="0" z="0"/>)"
         R"(</vertex><vertex><position x="0" y="1" z="0"/></vertex><vertex>)"
         R"(<position x="0" y="0" z="1"/></vertex></vertexbuffer></geometry></submesh>)"
         R"(</submeshes></mesh>)";
}

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_F(UnsetMemory, OfOgreIsRefused) {
  EXPECT_TRUE(import_mesh(write("whole.mesh.xml", ogre(3)), {.try_first = true}).ok());
  const Result<Imported> imported =
      import_mesh(write("index.mesh.xml", ogre(9)), {.try_first = true});
  ASSERT_EQ(imported.code(), Errc::kImportFailed);
  EXPECT_NE(imported.error().detail.find("memory that it has not set"), std::string::npos)
      << imported.error().detail;
}
#endif

}  // namespace
}  // namespace boxtree::cooker
