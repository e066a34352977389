// SPDX-License-Identifier: MIT
// What assimp's reader of glTF does not know: integers as positions, extensions that a file
// requires.
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cooker/import/gltf_unread.h"
#include "cooker/import/source_scene.h"
#include "gltf_text.h"
#include "temp_files.h"

namespace boxtree::cooker {
namespace {

using GltfTypes = ImportTest;

// A document with one triangle of vertices 0, 1, 2.
struct Document {
  std::string positions;  // bytes
  int stride = 0;
  int component_type = 5126;
  std::string type = "VEC3";
  std::string more_of_positions;  // members
  int index_type = 5123;
  std::string index_scalar = "SCALAR";
  std::string node = R"({"mesh":0})";
  std::string more;  // members
  std::size_t count = 3;

  [[nodiscard]] std::string text() const {
    const std::string numbers("\0\0\1\0\2\0\0\0", 8);
    const std::string stated = stride > 0 ? fmt::format(R"(,"byteStride":{})", stride) : "";
    return fmt::format(
        R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{}],)"
        R"("meshes":[{{"name":"m","primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],)"
        R"("accessors":[{{"bufferView":0,"componentType":{},"count":{},"type":"{}"{}}},)"
        R"({{"bufferView":1,"componentType":{},"count":3,"type":"{}"}}],)"
        R"("bufferViews":[{{"buffer":0,"byteLength":{}{}}},{{"buffer":1,"byteLength":8}}],)"
        R"("buffers":[{},{}]{}}})",
        node, component_type, count, type, more_of_positions, index_type, index_scalar,
        positions.size(), stated, buffer(positions), buffer(numbers), more);
  }

  static std::string buffer(const std::string& bytes) {
    return fmt::format(R"({{"byteLength":{},"uri":"data:application/octet-stream;base64,{}"}})",
                       bytes.size(), base64(bytes));
  }
};

// Three vertices, each with `padding` bytes behind it.
template <class T>
std::string bytes_of(const std::array<T, 9>& numbers, std::size_t padding) {
  std::string bytes;
  for (std::size_t vertex = 0; vertex < 3; ++vertex) {
    bytes.append(reinterpret_cast<const char*>(&numbers[3 * vertex]), 3 * sizeof(T));
    bytes.append(padding, '\x7f');
  }
  return bytes;
}

using Corners = std::vector<float>;

// Found by a newcomer: integers were taken for the bits of f32.
TEST_F(GltfTypes, IntegersAsTheyAre) {
  Document document;
  document.positions = bytes_of<std::int16_t>({-32768, 0, 7, 1000, -1, 0, 5, 32767, -300}, 2);
  document.stride = 8;
  document.component_type = 5122;
  document.more = R"(,"extensionsRequired":["KHR_mesh_quantization"])";
  EXPECT_EQ(load("a.gltf", document.text()).mesh.positions.f32,
            (Corners{-32768, 0, 7, 1000, -1, 0, 5, 32767, -300}));
  document.component_type = 5123;
  EXPECT_EQ(load("a.gltf", document.text()).mesh.positions.f32,
            (Corners{32768, 0, 7, 1000, 65535, 0, 5, 32767, 65236}));
  document.positions = bytes_of<std::uint8_t>({255, 0, 7, 128, 127, 0, 5, 1, 200}, 1);
  document.stride = 4;
  document.component_type = 5121;
  EXPECT_EQ(load("a.gltf", document.text()).mesh.positions.f32,
            (Corners{255, 0, 7, 128, 127, 0, 5, 1, 200}));
  document.component_type = 5120;
  EXPECT_EQ(load("a.gltf", document.text()).mesh.positions.f32,
            (Corners{-1, 0, 7, -128, 127, 0, 5, 1, -56}));
  // Without the extension a file means the same, and a node places it.
  document.more.clear();
  document.node = R"({"mesh":0,"scale":[2,2,2],"translation":[1,0,0]})";
  EXPECT_EQ(load("a.gltf", document.text()).mesh.positions.f32,
            (Corners{-1, 0, 14, -255, 254, 0, 11, 2, -112}));
}

// The quotients are those of the glTF 2.0 specification, 3.11, here of decimals.
TEST_F(GltfTypes, NormalizedIntegers) {
  Document document;
  document.more_of_positions = R"(,"normalized":true)";
  document.positions = bytes_of<std::int16_t>({-32768, 0, 32767, -32767, 1, 0, 16384, 2, 3}, 2);
  document.stride = 8;
  document.component_type = 5122;
  EXPECT_EQ(load("a.gltf", document.text()).mesh.positions.f32,
            (Corners{-1, 0, 1, -1, 3.0518509475997192e-05f, 0, 0.50001525925473800e+00f,
                     6.1037018951994385e-05f, 9.1555528427991577e-05f}));
  document.positions = bytes_of<std::uint8_t>({255, 0, 51, 0, 255, 0, 0, 0, 255}, 1);
  document.stride = 4;
  document.component_type = 5121;
  EXPECT_EQ(load("a.gltf", document.text()).mesh.positions.f32,
            (Corners{1, 0, 0.2f, 0, 1, 0, 0, 0, 1}));
  document.component_type = 5120;
  EXPECT_EQ(load("a.gltf", document.text()).mesh.positions.f32[2], 51.0f / 127.0f);
}

// Of several meshes each has its own type, also in a scene.
TEST_F(GltfTypes, MeshesOfSeveralTypes) {
  const std::string text = fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0,1]}}],)"
      R"("nodes":[{{"mesh":1}},{{"mesh":0}}],)"
      R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}},)"
      R"({{"primitives":[{{"attributes":{{"POSITION":1}}}},{{"attributes":{{"POSITION":2}}}}]}}],)"
      R"("accessors":[{{"bufferView":0,"componentType":5121,"count":3,"type":"VEC3"}},)"
      R"({{"bufferView":1,"componentType":5126,"count":3,"type":"VEC3"}},)"
      R"({{"bufferView":2,"componentType":5122,"count":3,"type":"VEC3"}}],)"
      R"("bufferViews":[{{"buffer":0,"byteLength":12,"byteStride":4}},)"
      R"({{"buffer":1,"byteLength":36}},{{"buffer":2,"byteLength":24,"byteStride":8}}],)"
      R"("buffers":[{},{},{}]}})",
      Document::buffer(bytes_of<std::uint8_t>({1, 2, 3, 4, 5, 6, 7, 8, 10}, 1)),
      Document::buffer(bytes_of<float>({0.5, 0, 0, 0, 1, 0, 0, 0, 1}, 0)),
      Document::buffer(bytes_of<std::int16_t>({-9, 0, 0, 0, -9, 0, 0, 0, -9}, 2)));
  const Result<SourceScene> scene = import_scene(write("a.gltf", text), {});
  ASSERT_TRUE(scene.ok()) << scene.error().message();
  ASSERT_EQ(scene->meshes.size(), 2u);
  EXPECT_EQ(scene->meshes[0].mesh.positions.f32,
            (Corners{0.5, 0, 0, 0, 1, 0, 0, 0, 1, -9, 0, 0, 0, -9, 0, 0, 0, -9}));
  EXPECT_EQ(scene->meshes[1].mesh.positions.f32, (Corners{1, 2, 3, 4, 5, 6, 7, 8, 10}));
}

// Found by a newcomer: coordinates in two dimensions became garbage.
TEST_F(GltfTypes, OtherTypesAreRefused) {
  Document good;
  good.positions = bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, 0);
  EXPECT_EQ(load("a.gltf", good.text()).mesh.faces.size(), 1u);
  const auto refusal = [&](const Document& document) {
    const Error error = fail("a.gltf", document.text());
    EXPECT_EQ(error.code, Errc::kImportFailed);
    return error.detail;
  };
  Document flat = good;
  flat.type = "VEC2";
  EXPECT_TRUE(has(refusal(flat), "mesh 'm', primitive 0: positions are VEC2 of FLOAT; expected"));
  Document whole = good;
  whole.component_type = 5125;
  EXPECT_TRUE(has(refusal(whole), "positions are VEC3 of UNSIGNED_INT; expected VEC3 of FLOAT"));
  whole.component_type = 5130;
  EXPECT_TRUE(has(refusal(whole), "positions are VEC3 of component type 5130"));
  Document indices = good;
  indices.index_type = 5122;
  EXPECT_TRUE(has(refusal(indices), "vertex numbers are SCALAR of SHORT; expected SCALAR of"));
  indices.index_type = 5126;
  EXPECT_TRUE(has(refusal(indices), "vertex numbers are SCALAR of FLOAT"));
  indices = good;
  indices.index_scalar = "VEC2";
  EXPECT_TRUE(has(refusal(indices), "vertex numbers are VEC2 of UNSIGNED_SHORT"));
}

// Assimp patches packed positions; it takes those among other data for packed, too.
TEST_F(GltfTypes, SparsePositions) {
  Document document;
  document.positions = bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, 0);
  document.more_of_positions =
      R"(,"sparse":{"count":1,"indices":{"bufferView":1,"byteOffset":2,"componentType":5123},)"
      R"("values":{"bufferView":0,"byteOffset":24}})";
  EXPECT_EQ(load("a.gltf", document.text()).mesh.positions.f32, (Corners{0, 0, 0, 0, 1, 0}))
      << "vertex 1 is where vertex 2 is";
  document.positions = bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, 4);
  document.stride = 16;
  EXPECT_TRUE(has(fail("a.gltf", document.text()).detail, "positions are sparse among other data"));
}

// Found by a newcomer: extensionsRequired was passed over.
TEST_F(GltfTypes, RequiredExtensions) {
  Document document;
  document.positions = bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, 0);
  for (const char* name :
       {"KHR_materials_unlit", "EXT_texture_webp", "KHR_texture_transform", "KHR_lights_punctual",
        "KHR_mesh_quantization", "ADOBE_materials_thin", "KHR_draco_mesh_compression",
        "KHR_xmp_json_ld", "EXT_structural_metadata"}) {
    document.more = fmt::format(R"(,"extensionsRequired":["{}"])", name);
    EXPECT_EQ(load("a.gltf", document.text()).mesh.faces.size(), 1u) << name;
  }
  const auto refusal = [&](const char* name) {
    document.more = fmt::format(R"(,"extensionsRequired":["KHR_materials_unlit","{}"])", name);
    const Error error = fail("a.gltf", document.text());
    EXPECT_EQ(error.code, Errc::kImportFailed);
    EXPECT_TRUE(has(error.detail, fmt::format("it requires the extension {} of glTF", name)));
    return error.detail;
  };
  EXPECT_TRUE(has(refusal("EXT_meshopt_compression"), "without -c and -cc"));
  EXPECT_TRUE(has(refusal("EXT_mesh_gpu_instancing"), "without -mi"));
  EXPECT_TRUE(has(refusal("EXT_foo"), "export it without that"));
  EXPECT_TRUE(has(refusal("materials_"), "export it without that"));
  EXPECT_TRUE(has(refusal(""), "export it without that"));
}

// Found by a newcomer: instances were lost in silence.
TEST_F(GltfTypes, InstancesThatAreNotRead) {
  Document document;
  document.positions = bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, 0);
  EXPECT_TRUE(load("a.gltf", document.text()).report.unread.empty());
  document.node = R"({"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{}}}})";
  document.more = R"(,"extensionsUsed":["EXT_mesh_gpu_instancing"])";
  const std::vector<Unread> unread = load("a.gltf", document.text()).report.unread;
  ASSERT_EQ(unread.size(), 1u);
  EXPECT_EQ(unread[0].what, "EXT_mesh_gpu_instancing");
  EXPECT_EQ(unread[0].count, 1u);
  EXPECT_EQ(unread[0].line, 0u);
}

// Found by a newcomer: what poses or shapes a mesh, and other scenes, were lost in silence.
TEST_F(GltfTypes, SkinsWeightsAndScenesThatAreNotRead) {
  Document document;
  document.positions = bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, 0);
  const auto unread = [&] {
    std::string all;
    for (const Unread& part : load("a.gltf", document.text()).report.unread)
      all += fmt::format("{} {};", part.what, part.count);
    return all;
  };
  document.node = R"({"mesh":0,"weights":[0,0.5]})";
  EXPECT_EQ(unread(), "weights of morph targets 1;");
  document.node = R"({"mesh":0,"weights":[0,0.0]})";
  EXPECT_EQ(unread(), "");
  std::string text = document.text();
  const std::string scenes = R"("scenes":[)";
  text.insert(text.find(scenes) + scenes.size(), R"({"nodes":[0]},)");
  const std::vector<Unread> of_scenes = load("a.gltf", text).report.unread;
  ASSERT_EQ(of_scenes.size(), 1u);
  EXPECT_EQ(of_scenes[0].what, "other scenes");
  const auto of_text = [](const char* json) { return unread_of_gltf(parse_json(json).value); };
  const std::vector<Unread> skins = of_text(R"({"nodes":[{"mesh":0,"skin":0},{"skin":0},7]})");
  ASSERT_EQ(skins.size(), 1u);
  EXPECT_EQ(skins[0].what, "skins");
  EXPECT_EQ(skins[0].count, 1u);
  for (const char* any : {"7", R"({"nodes":7,"meshes":{},"scenes":7})",
                          R"({"meshes":[{"weights":["a",{}]},{"weights":7}]})"}) {
    EXPECT_TRUE(of_text(any).empty()) << any;
  }
}

// The document may hold anything.
TEST_F(GltfTypes, DocumentsOfAnyShape) {
  Document document;
  document.positions = bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, 0);
  for (const char* more : {R"(,"extensionsRequired":7)", R"(,"extensionsRequired":[7,{}])",
                           R"(,"extensionsRequired":{})"}) {
    document.more = more;
    static_cast<void>(import_mesh(write("a.gltf", document.text())));
  }
  document.more.clear();
  document.node = "7";
  static_cast<void>(import_mesh(write("a.gltf", document.text())));
  for (const char* type : {R"("componentType":[],)", R"("componentType":5122.5,)"}) {
    std::string text = document.text();
    text.replace(text.find(R"("componentType":5126)"), 20, std::string(type) + R"("x":0)");
    EXPECT_TRUE(has(fail("a.gltf", text).detail, "positions are "));
  }
}

}  // namespace
}  // namespace boxtree::cooker
