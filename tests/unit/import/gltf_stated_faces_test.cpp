// SPDX-License-Identifier: MIT
// What a document of glTF states, and documents that lie about their own shape.
#include "cooker/import/gltf_stated_faces.h"

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
