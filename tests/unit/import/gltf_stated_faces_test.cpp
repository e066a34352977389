// SPDX-License-Identifier: MIT
// What a document of glTF states, and documents that lie about their own shape.
#include "cooker/import/gltf_stated_faces.h"

#include <assimp/scene.h>
#include <gtest/gtest.h>

namespace boxtree::cooker {
namespace {

using Counts = decltype(StatedFaces::counts);

Counts stated(const char* json) {
  return stated_faces(parse_json(json).value).counts;
}

TEST(GltfStatedFaces, PrimitivesByTheirMode) {
  EXPECT_EQ(stated(R"({"accessors":[{"count":8},{"count":36}],"meshes":[{"primitives":[
                   {"attributes":{"POSITION":0},"indices":1},
                   {"attributes":{"POSITION":0},"indices":1,"mode":4},
                   {"attributes":{"POSITION":0},"indices":1,"mode":5},
                   {"attributes":{"POSITION":0},"mode":6},
                   {"attributes":{"POSITION":1},"mode":1}]}]})"),
            (Counts{{8, 12}, {8, 12}, {8, 34}, {8, 6}, {36, 0}}));
}

// Found on Debian 13, whose assimp leaves out vertices that no face names: a level was refused.
TEST(GltfStatedFaces, AllFacesWithTheVerticesThatTheyName) {
  const StatedFaces document = stated_faces(
      parse_json(
          R"({"accessors":[{"count":8},{"count":36}],"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}],
                     "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}]})")
          .value);
  const auto is_whole = [&](unsigned vertices, unsigned faces) {
    auto* const mesh = new aiMesh;
    mesh->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
    mesh->mNumVertices = vertices;
    mesh->mNumFaces = faces;
    mesh->mFaces = new aiFace[faces];
    aiScene scene;
    scene.mNumMeshes = 1;
    scene.mMeshes = new aiMesh* [1] { mesh };
    scene.mRootNode = new aiNode;
    scene.mRootNode->mNumMeshes = 1;
    scene.mRootNode->mMeshes = new unsigned[1]{0};
    return check_stated_faces(document, scene).ok();
  };
  EXPECT_TRUE(is_whole(8, 12));
  EXPECT_TRUE(is_whole(7, 12));
  EXPECT_FALSE(is_whole(9, 12));
  EXPECT_FALSE(is_whole(8, 11));
  EXPECT_FALSE(is_whole(7, 13));
}

TEST(GltfStatedFaces, DocumentsOfAnyShape) {
  for (const char* json :
       {"", "{", "[]", "7", "null", "{}", R"({"meshes":{}})", R"({"meshes":[7,[],{}]})",
        R"({"meshes":[{"primitives":{}},{"primitives":[]}]})"}) {
    EXPECT_EQ(stated(json), Counts()) << json;
  }
  for (const char* json :
       {R"({"meshes":[{"primitives":[{}]}]})",
        R"({"accessors":[1],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]})",
        R"({"accessors":[],"meshes":[{"primitives":[{"attributes":7,"indices":-1}]}]})",
        R"({"accessors":{},"meshes":[{"primitives":[{"attributes":[],"indices":"x"}]}]})",
        R"({"meshes":[{"primitives":["x"]}]})",
        R"({"meshes":[{"primitives":[{"indices":18446744073709551615,"mode":[]}]}]})"}) {
    EXPECT_EQ(stated(json), (Counts{{0, 0}})) << json;
  }
}

}  // namespace
}  // namespace boxtree::cooker
