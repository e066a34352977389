// SPDX-License-Identifier: MIT
// Values of glTF 2 that assimp takes for others, or reads past: each is refused by its place.
#include "cooker/import/gltf_values.h"

#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "temp_files.h"

namespace boxtree::cooker {
namespace {

using Library = nlohmann::json;

// Two nodes with a triangle of 3 of 4 vertices, the fourth behind every vertex.
Library two_triangles() {
  return Library::parse(R"({
    "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"children": [1], "rotation": [0, 0, 0.7071, 0.7071]},
              {"mesh": 0, "translation": [1, 2, 3], "scale": [1, 1, 1]}],
    "meshes": [{"name": "m", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                  {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR",
                   "byteOffset": 2}],
    "bufferViews": [{"buffer": 0, "byteLength": 44, "byteStride": 16},
                    {"buffer": 0, "byteOffset": 44, "byteLength": 8}],
    "buffers": [{"byteLength": 52}]})");
}

std::string fault(const Library& json) {
  const Status status = check_values(parse_json(json.dump()).value);
  if (status.ok()) return "";
  EXPECT_EQ(status.error().code, Errc::kImportFailed);
  return status.error().detail;
}

// Of the document with `value` at `place`.
std::string fault(const char* place, const char* value) {
  Library json = two_triangles();
  json[Library::json_pointer(place)] = Library::parse(value);
  return fault(json);
}

// Of the document with a matrix in place of node 0's rotation.
std::string with_matrix(const char* matrix) {
  Library json = two_triangles();
  json["nodes"][0].erase("rotation");
  json["nodes"][0]["matrix"] = Library::parse(matrix);
  return fault(json);
}

TEST(GltfValues, TheSpecificationsArePassed) {
  EXPECT_EQ(fault(two_triangles()), "");
  EXPECT_EQ(with_matrix("[1,0,0,0, 0,1,0,0, 0,0,1,0, 5,6,7,1]"), "");
  EXPECT_EQ(fault("/meshes/0/primitives/0/mode", "6"), "");
  Library compressed = two_triangles();
  for (Library& accessor : compressed["accessors"]) accessor.erase("bufferView");
  EXPECT_EQ(fault(compressed),
            "accessor 0: bufferView: expected one, without which all are zeros, found none");
  compressed["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {};
  EXPECT_EQ(fault(compressed), "");
  // glTF 1, and what is no document of glTF at all.
  for (const char* json : {"{}", "[]", "7", "null", R"({"nodes":{"a":{"matrix":[1]}},"scene":"s"})",
                           R"({"scene":"s","scenes":{"s":{"nodes":["a"]}},"meshes":{"m":7}})"}) {
    EXPECT_EQ(fault(Library::parse(json)), "") << json;
  }
}

TEST(GltfValues, WhatIsNoIndexIsRefused) {
  EXPECT_EQ(fault("/scene", "1"),
            "the document: scene: expected an index of the 1 scenes, found 1");
  EXPECT_EQ(fault("/scenes/0/nodes/0", "0.0"),
            "scene 0: nodes: expected an index of the 2 nodes, found 0.0");
  EXPECT_EQ(fault("/scenes/0/nodes", "0"), "scene 0: nodes: expected a list, found 0");
  EXPECT_EQ(fault("/nodes/0/children/0", "-1"),
            "node 0: children: expected an index of the 2 nodes, found -1");
  EXPECT_EQ(fault("/nodes/1", "[]"), "node 1: expected an object, found a list of 0");
  EXPECT_EQ(fault("/nodes/1/mesh", R"("m")"),
            R"(node 1: mesh: expected an index of the 1 meshes, found "m")");
  EXPECT_EQ(fault("/meshes/0/primitives/0/indices", "2"),
            "mesh 'm', primitive 0: indices: expected an index of the 2 accessors, found 2");
  EXPECT_EQ(fault("/accessors/0/bufferView", "9"),
            "accessor 0: bufferView: expected an index of the 2 bufferViews, found 9");
  EXPECT_EQ(fault("/bufferViews/0/buffer", "true"),
            "bufferView 0: buffer: expected an index of the 1 buffers, found true");
}

TEST(GltfValues, PlacesAreOfTheirNumbers) {
  EXPECT_EQ(fault("/nodes/1/translation", "[1,2]"),
            "node 1: translation: expected 3 numbers, found a list of 2");
  EXPECT_EQ(fault("/nodes/1/translation", "null"),
            "node 1: translation: expected 3 numbers, found null");
  EXPECT_EQ(fault("/nodes/1/scale", R"([1,"2",3])"),
            R"(node 1: scale: expected 3 numbers, found "2")");
  EXPECT_EQ(fault("/nodes/0/rotation", "[0,0,0,2]"),
            "node 0: rotation: expected a quaternion of length 1, found length 2");
  EXPECT_EQ(fault("/nodes/0/rotation", "[0,0,0,0]"),
            "node 0: rotation: expected a quaternion of length 1, found length 0");
  EXPECT_EQ(with_matrix("[1,0,0,0, 0,1,0,0, 0,0,1,0]"),
            "node 0: matrix: expected 16 numbers, found a list of 12");
  EXPECT_EQ(with_matrix("[1,0,0,0, 0,1,0,0, 0,0,1,-0.5, 0,0,0,1]"),
            "node 0: matrix: expected 0, 0, 0, 1 as its last row, found -0.5 in column 2");
}

// Found by a newcomer: assimp takes the matrix, and places what is named twice in one place twice.
TEST(GltfValues, NodesDoNotContradictThemselves) {
  EXPECT_EQ(fault("/nodes/0/matrix", "[1,0,0,0, 0,1,0,0, 0,0,1,0, 5,6,7,1]"),
            "node 0: matrix: expected a matrix alone, found a rotation, too");
  EXPECT_EQ(fault("/scenes/0/nodes", "[0,0]"),
            "scene 0: nodes: expected each node once, found 0 twice");
  EXPECT_EQ(fault("/nodes/0/children", "[1,1]"),
            "node 0: children: expected each node once, found 1 twice");
  EXPECT_EQ(fault("/scenes/0/nodes", "[0,1]"),
            "scene 0: nodes: expected nodes without a parent, found 1, a child of 0");
  // Several parents of one node place it as often: not of the format, but as meant.
  EXPECT_EQ(fault("/nodes/2", R"({"children":[1]})"), "");
}

TEST(GltfValues, PrimitivesHavePositions) {
  EXPECT_EQ(fault("/meshes/0/primitives/0/mode", "7"),
            "mesh 'm', primitive 0: mode: expected 0 to 6, found 7");
  EXPECT_EQ(fault("/meshes/0/primitives/0/mode", R"("TRIANGLES")"),
            R"(mesh 'm', primitive 0: mode: expected 0 to 6, found "TRIANGLES")");
  EXPECT_EQ(fault("/meshes/0/primitives/0/attributes", "{}"),
            "mesh 'm', primitive 0: attributes: expected POSITION, found none");
  EXPECT_EQ(fault("/meshes/0/primitives/0", "{}"),
            "mesh 'm', primitive 0: attributes: expected an object with POSITION, found none");
  EXPECT_EQ(fault("/meshes/0/primitives", "{}"),
            "mesh 0: primitives: expected a list, found an object");
}

// Of fewer assimp took two from their number: 2^32 faces, for which there was no memory.
TEST(GltfValues, StripsHaveCorners) {
  Library json = two_triangles();
  json["meshes"][0]["primitives"][0]["mode"] = 5u;
  EXPECT_EQ(fault(json), "");
  json["accessors"][1]["count"] = 2u;
  EXPECT_EQ(fault(json),
            "mesh 'm', primitive 0: expected 3 or more corners of a strip or fan, found 2");
}

// Found by a newcomer: what was left of a list of triangles was dropped.
TEST(GltfValues, TrianglesAreWhole) {
  Library json = two_triangles();
  json["accessors"][1]["count"] = 2u;
  EXPECT_EQ(fault(json), "mesh 'm', primitive 0: expected a multiple of 3 corners, found 2");
  json["meshes"][0]["primitives"][0]["mode"] = 1u;  // lines
  EXPECT_EQ(fault(json), "");
  Library without_indices = two_triangles();
  without_indices["meshes"][0]["primitives"][0].erase("indices");
  EXPECT_EQ(fault(without_indices), "");
  without_indices["accessors"][0]["count"] = 2u;
  EXPECT_EQ(fault(without_indices),
            "mesh 'm', primitive 0: expected a multiple of 3 corners, found 2");
}

TEST(GltfValues, SkinsHaveTheirMatrices) {
  EXPECT_EQ(fault("/skins", R"([{"joints":[0],"inverseBindMatrices":1}])"), "");
  EXPECT_EQ(fault("/skins", R"([{"joints":[0]}])"),
            "skin 0: inverseBindMatrices: expected an accessor, without which assimp's reader "
            "crashes, found none; export the meshes without skins");
}

TEST(GltfValues, NothingIsReadPastItsBuffer) {
  EXPECT_EQ(fault("/accessors/0/count", "0"),
            "accessor 0: count: expected a whole number of 1 or more, found 0");
  EXPECT_EQ(fault("/accessors/0/count", "4"),
            "accessor 0: count: expected no more than the 44 bytes of bufferView 0 hold from byte "
            "0 on, found 4");
  EXPECT_EQ(fault("/accessors/1/count", "6"),
            "accessor 1: count: expected no more than the 8 bytes of bufferView 1 hold from byte "
            "2 on, found 6");
  EXPECT_NE(fault("/accessors/0/count", "18446744073709551615"), "");
  EXPECT_EQ(fault("/accessors/1/byteOffset", "-1"),
            "accessor 1: byteOffset: expected a whole number of 0 or more, found -1");
  EXPECT_NE(fault("/accessors/1/byteOffset", "18446744073709551615"), "");
  EXPECT_EQ(fault("/bufferViews/1/byteOffset", "45"),
            "bufferView 1: byteLength: expected to end within the 52 bytes of buffer 0, found 8 "
            "from byte 45 on");
  EXPECT_NE(fault("/bufferViews/1/byteOffset", "18446744073709551612"), "");
  EXPECT_EQ(fault("/bufferViews/0/byteStride", "8"),
            "bufferView 0: byteStride: expected a whole number of 12 or more, found 8");
  EXPECT_NE(fault("/bufferViews/0/byteStride", "4294967296"), "");
  EXPECT_EQ(fault("/buffers/0", "{}"),
            "bufferView 0: byteLength: expected to end within the 0 bytes of buffer 0, found 44 "
            "from byte 0 on");
}

TEST(GltfValues, SparseAccessorsHaveTheirBytes) {
  const auto sparse = [](const char* count, const char* indices, const char* values) {
    Library json = two_triangles();
    json["accessors"][0]["sparse"] = {{"count", Library::parse(count)},
                                      {"indices", Library::parse(indices)},
                                      {"values", Library::parse(values)}};
    return fault(json);
  };
  const char* const indices = R"({"bufferView":1,"componentType":5123})";
  EXPECT_EQ(sparse("2", indices, R"({"bufferView":0})"), "");
  EXPECT_EQ(sparse("4", indices, R"({"bufferView":0})"),
            "accessor 0, sparse: count: expected at most 3, as many as it replaces of, found 4");
  EXPECT_EQ(sparse("2", R"({"bufferView":1,"componentType":5126})", R"({"bufferView":0})"),
            "accessor 0, sparse: componentType of indices: expected UNSIGNED_BYTE, UNSIGNED_SHORT "
            "or UNSIGNED_INT, found FLOAT");
  EXPECT_EQ(sparse("2", indices, "{}"), "accessor 0, sparse: bufferView: expected one, found none");
  EXPECT_EQ(sparse("2", indices, R"({"bufferView":0,"byteOffset":33})"),
            "accessor 0, sparse: count: expected no more than the 44 bytes of bufferView 0 hold "
            "from byte 33 on, found 2");
}

using GltfFiles = ImportTest;

// What is no JSON to the checks was read without them: assimp takes any bytes for text.
TEST_F(GltfFiles, NamesAreUtf8) {
  const Error error =
      fail("a.gltf", "{\"asset\":{\"version\":\"2.0\"},\n\"nodes\":[{\"name\":\"caf\xe9\"}]}");
  EXPECT_EQ(error.code, Errc::kImportFailed);
  EXPECT_TRUE(has(error.detail, "its JSON is no UTF-8 in line 2, at byte 50 of 54"));
}

}  // namespace
}  // namespace boxtree::cooker
