// SPDX-License-Identifier: MIT
// Numbers of faces from properties of PLY files in each form and type, from groups of OBJ files,
// and from primitives of glTF files and their extras.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>

#include "cooker/import/source_scene.h"
#include "gltf_text.h"
#include "temp_files.h"

namespace boxtree::cooker {
namespace {

using UserDataTest = ImportTest;
using Numbers = std::vector<std::uint32_t>;

const std::vector<float> kPositionsOfOne = {0, 0, 0, 1, 0, 0, 0, 1, 0};
const std::vector<float> kTwo = {0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 1, 2, 0, 1, 0, 2, 1};

ImportOptions with_data(const std::string& property) {
  ImportOptions options;
  options.user_data = property;
  return options;
}

// Of each face of the mesh.
Numbers numbers_of(const Imported& imported) {
  Numbers numbers;
  for (std::size_t face = 0; face < imported.mesh.faces.size(); ++face) {
    std::uint32_t number = 0;
    for (const FaceRun& run : imported.user_data) {
      if (run.first_face <= imported.mesh.face_id(face)) number = run.number;
    }
    numbers.push_back(number);
  }
  return numbers;
}

constexpr const char* kSevenVertices = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 0 0\n2 1 5\n3 0 0\n";

// A PLY text, a row of `faces` each with its number before and after the corners.
std::string ply_with_data(const std::string& type, const std::vector<std::string>& faces) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 7\nproperty float x\nproperty float y\n"
      "property float z\nelement face " +
      std::to_string(faces.size()) + "\nproperty " + type +
      " zone\nproperty list uchar int vertex_indices\n"
      "property float heat\nend_header\n";
  text += kSevenVertices;
  for (const std::string& face : faces) text += face + "\n";
  return text;
}

TEST_F(UserDataTest, IsThePropertyOfEachFaceAndOfItsParts) {
  const std::vector<std::string> faces = {"7 3 0 1 2 0.5",          // a triangle
                                          "9 2 0 1 0.5",            // no face, so it has no number
                                          "300 4 0 1 2 3 0.5",      // a quad that stays one
                                          "300 4 1 4 5 2 0.5",      // one that is not planar, split
                                          "70000 5 0 1 4 2 3 0.5",  // split
                                          "7 3 4 6 5 0.5"};
  const Imported imported = load("a.ply", ply_with_data("int", faces), with_data("zone"));
  EXPECT_EQ(numbers_of(imported), (Numbers{7, 300, 300, 300, 70000, 70000, 70000, 7}));
  EXPECT_EQ(imported.user_data, (std::vector<FaceRun>{{0, 7}, {1, 300}, {3, 70000}, {4, 7}}));
  EXPECT_TRUE(load("a.ply", ply_with_data("int", faces)).user_data.empty());
}

TEST_F(UserDataTest, BelowZeroIsTheSame32Bits) {
  const Imported imported =
      load("a.ply",
           ply_with_data("int", {"-1 3 0 1 2 0", "-2147483648 3 0 2 3 0", "2147483647 3 1 4 5 0"}),
           with_data("zone"));
  EXPECT_EQ(numbers_of(imported), (Numbers{0xffffffffu, 0x80000000u, 0x7fffffffu}));
  const Imported large =
      load("a.ply", ply_with_data("uint", {"4294967295 3 0 1 2 0"}), with_data("zone"));
  EXPECT_EQ(numbers_of(large), Numbers{0xffffffffu});
}

TEST_F(UserDataTest, OfTextIsAnIntegerOf32Bits) {
  for (const std::string word : {"1.5", "4294967296", "-2147483649"}) {
    const Error error =
        fail("a.ply", ply_with_data("int", {word + " 3 0 1 2 0"}), with_data("zone"));
    EXPECT_EQ(error.code, Errc::kImportFailed);
    EXPECT_NE(error.detail.find("line 19: user data '" + word + "' is no integer of 32 bits"),
              std::string::npos)
        << error.detail;
  }
}

template <class T>
void put(std::string& bytes, T value, bool swapped) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), &value, sizeof(T));
  if (swapped) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

// Two triangles with a number each.
template <class T>
std::string binary_ply(const std::string& type, T first, T second, bool is_big) {
  std::string bytes = std::string("ply\nformat binary_") + (is_big ? "big" : "little") +
                      "_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                      "property float z\nelement face 2\nproperty list uchar int vertex_indices\n"
                      "property " +
                      type + " zone\nend_header\n";
  const bool swapped = is_big == (std::endian::native == std::endian::little);
  for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 1.f, 0.f}) {
    put(bytes, x, swapped);
  }
  for (const auto& [corners, number] :
       {std::pair(std::array{0, 1, 2}, first), std::pair(std::array{0, 2, 3}, second)}) {
    put(bytes, std::uint8_t{3}, swapped);
    for (const int corner : corners) put(bytes, std::int32_t{corner}, swapped);
    put(bytes, number, swapped);
  }
  return bytes;
}

TEST_F(UserDataTest, OfBinaryFilesHasAnyIntegerTypeAndByteOrder) {
  const auto numbers = [&](const std::string& bytes) {
    return numbers_of(load("a.ply", bytes, with_data("zone")));
  };
  for (const bool is_big : {false, true}) {
    EXPECT_EQ(numbers(binary_ply("uchar", std::uint8_t{3}, std::uint8_t{255}, is_big)),
              (Numbers{3, 255}));
    EXPECT_EQ(numbers(binary_ply("char", std::int8_t{3}, std::int8_t{-2}, is_big)),
              (Numbers{3, 0xfffffffeu}));
    EXPECT_EQ(numbers(binary_ply("ushort", std::uint16_t{0x102}, std::uint16_t{0xffff}, is_big)),
              (Numbers{0x102, 0xffff}));
    EXPECT_EQ(numbers(binary_ply("short", std::int16_t{0x102}, std::int16_t{-2}, is_big)),
              (Numbers{0x102, 0xfffffffeu}));
    EXPECT_EQ(numbers(binary_ply("uint", 0x01020304u, 0xffffffffu, is_big)),
              (Numbers{0x01020304u, 0xffffffffu}));
    EXPECT_EQ(numbers(binary_ply("int32", 0x01020304, -1, is_big)),
              (Numbers{0x01020304u, 0xffffffffu}));
  }
}

TEST_F(UserDataTest, ThatAFileDoesNotHaveIsRefused) {
  const auto refusal = [&](const std::string& name, const std::string& bytes,
                           const std::string& property) {
    const Error error = fail(name, bytes, with_data(property));
    EXPECT_EQ(error.code, Errc::kMeshUnsupported);
    return error.detail.substr(error.detail.find(name));
  };
  const std::string ply = ply_with_data("int", {"1 3 0 1 2 0"});
  EXPECT_EQ(refusal("a.ply", ply, "zome"),
            "a.ply: user data of faces 'zome': faces have no such property; integers of theirs "
            "are: zone; did you mean 'zone'?");
  EXPECT_EQ(refusal("a.ply", ply_with_data("float", {"1 3 0 1 2 0"}), "groups"),
            "a.ply: user data of faces 'groups': faces have no such property; they have none that "
            "is an integer");
  EXPECT_EQ(refusal("a.ply", ply, "heat"),
            "a.ply: user data of faces 'heat': expected an integer, found a floating-point number");
  EXPECT_EQ(refusal("a.ply", ply, "vertex_indices"),
            "a.ply: user data of faces 'vertex_indices': expected one integer a face, found a "
            "list");
  std::string twice = ply;
  twice.replace(twice.find("float heat"), 10, "short zone");
  EXPECT_EQ(refusal("a.ply", twice, "zone"),
            "a.ply: user data of faces 'zone': faces have it twice");
  EXPECT_EQ(refusal("a.ply",
                    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                    "property float z\nelement tristrips 1\nproperty list int int vertex_indices\n"
                    "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
                    "zone"),
            "a.ply: user data of faces 'zone': the file has 'tristrips', whose triangles have no "
            "properties of their own");
  EXPECT_EQ(refusal("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "zone"),
            "a.obj: user data of faces 'zone': an OBJ file has 'groups' alone");
  EXPECT_EQ(refusal("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "group"),
            "a.obj: user data of faces 'group': an OBJ file has 'groups' alone; did you mean "
            "'groups'?");
  const std::string others =
      ": user data of faces 'zone': expected a PLY file, whose faces have properties, an OBJ file, "
      "which has groups, or a glTF file, which has primitives and extras";
  EXPECT_EQ(refusal("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "zone"),
            "a.off" + others);
  EXPECT_EQ(refusal("a.stl", "solid\nendsolid\n", "zone"), "a.stl" + others);
  EXPECT_EQ(refusal("a.dae", "<COLLADA/>", "zone"), "a.dae" + others);
}

TEST_F(UserDataTest, OfGroupsIsTheirNumberByFirstFace) {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  const Imported imported = load("a.obj",
                                 points +
                                     "g empty\ng b  c\nf 1 2 3\no object\nf 1 3 4\ng a\nf 1 2 4\n"
                                     "g b c\nf 2 3 4\ng\nf 4 3 2\ng default\nf 3 2 1\n",
                                 with_data("groups"));
  EXPECT_EQ(numbers_of(imported), (Numbers{0, 0, 1, 0, 2, 2}));
  EXPECT_FALSE(imported.report.has_no_groups);
  const Imported before = load("a.obj", points + "f 1 2 3\ng a\nf 1 3 4\n", with_data("groups"));
  EXPECT_EQ(numbers_of(before), (Numbers{0, 1}));
  const Imported none = load("a.obj", points + "f 1 2 3\nf 1 3 4\n", with_data("groups"));
  EXPECT_EQ(numbers_of(none), (Numbers{0, 0}));
  EXPECT_TRUE(none.report.has_no_groups);
}

// Nodes place meshes in another order than the file lists them, one twice and one not at all.
constexpr const char* kNodes =
    R"({"children":[1,2,3]},{"mesh":2},{"mesh":0,"children":[4]},{"mesh":2,"translation":[0,0,9]},)"
    R"({"mesh":3})";

TEST_F(UserDataTest, OfPrimitivesIsTheirNumberInTheFile) {
  GltfText gltf;
  gltf.add_mesh("car", {{kTwo}, {kPositionsOfOne, -1, 0}, {kPositionsOfOne}});
  gltf.add_mesh("nowhere", {{kPositionsOfOne}});
  gltf.add_mesh("", {{kTwo}});
  gltf.add_mesh("lamp", {{kPositionsOfOne}, {kPositionsOfOne}});
  const std::string text = gltf.text(kNodes);
  const Imported imported = load("a.gltf", text, with_data("primitives"));
  EXPECT_EQ(numbers_of(imported), (Numbers{4, 4, 0, 0, 2, 5, 6, 4, 4}));
  EXPECT_EQ(imported.report.primitives,
            (std::vector<std::string>{"car-0", "car-1", "car-2", "nowhere", "mesh 2", "lamp-0",
                                      "lamp-1"}));
  EXPECT_TRUE(load("a.gltf", text).report.primitives.empty());
  EXPECT_TRUE(load("a.gltf", text).user_data.empty());
  // Of one root, and of several.
  EXPECT_EQ(numbers_of(load("b.gltf", gltf.text(R"({"mesh":0})"), with_data("primitives"))),
            (Numbers{0, 0, 2}));
  std::string roots = gltf.text(R"({"mesh":3},{"mesh":0})");
  roots.replace(roots.find("[0]"), 3, "[0,1]");
  EXPECT_EQ(numbers_of(load("c.gltf", roots, with_data("primitives"))), (Numbers{5, 6, 0, 0, 2}));
}

TEST_F(UserDataTest, OfPrimitivesInAScene) {
  GltfText gltf;
  gltf.add_mesh("car", {{kTwo}, {kPositionsOfOne}});
  gltf.add_mesh("box", {{kPositionsOfOne}});
  gltf.add_mesh("box of the same shape", {{kPositionsOfOne}});
  gltf.add_mesh("lamp", {{kTwo}});
  const auto path = write("a.gltf", gltf.text(kNodes));
  const Result<SourceScene> scene = import_scene(path, with_data("primitives"));
  ASSERT_TRUE(scene.ok()) << scene.error().message();
  ASSERT_EQ(scene->instances.size(), 4u);
  const auto of = [&](std::size_t instance) {
    return scene->meshes[scene->instances[instance].mesh].user_data;
  };
  EXPECT_EQ(of(0), (std::vector<FaceRun>{{0, 3}}));
  EXPECT_EQ(of(1), (std::vector<FaceRun>{{0, 0}, {2, 1}}));
  EXPECT_EQ(of(2), (std::vector<FaceRun>{{0, 4}}));
  EXPECT_EQ(scene->instances[0].mesh, scene->instances[3].mesh) << "instances share the numbers";
}

TEST_F(UserDataTest, OfExtrasIsThatOfThePrimitiveOrItsMaterialOrItsMesh) {
  GltfText gltf;
  gltf.add_mesh("a",
                {{kTwo, 0, 4, R"({"zone":7})"},
                 {kPositionsOfOne, 0},
                 {kPositionsOfOne, 1, 4, R"({"other":1})"},
                 {kPositionsOfOne}},
                R"({"zone":-1,"depth":2.5,"text":"x"})");
  gltf.add_mesh(
      "b", {{kPositionsOfOne, 1, 4, "[3]"}, {kPositionsOfOne, 0, 4, R"({"zone":4294967295.0})"}});
  const std::string text = gltf.text(R"({"children":[1,2]},{"mesh":1},{"mesh":0})",
                                     R"({"extras":{"zone":70000}},{"extras":{"zones":[1]}})");
  EXPECT_EQ(numbers_of(load("a.gltf", text, with_data("zone"))),
            (Numbers{0, 0xffffffffu, 7, 7, 70000, 0xffffffffu, 0xffffffffu}));
  const auto refusal = [&](const std::string& name) {
    const Error error = fail("a.gltf", text, with_data(name));
    EXPECT_EQ(error.code, Errc::kMeshUnsupported);
    return error.detail.substr(error.detail.find("a.gltf"));
  };
  EXPECT_EQ(refusal("zome"),
            "a.gltf: user data of faces 'zome': no primitive has it in its extras, nor has its "
            "material or mesh; integers of theirs are: other or zone, and 'primitives' numbers "
            "them; did you mean 'zone'?");
  EXPECT_TRUE(has(refusal("primitive"), "did you mean 'primitives'?"));
  for (const auto& [name, found] : {std::pair("depth", "2.5"), std::pair("text", "\"x\"")}) {
    const Error error = fail("a.gltf", text, with_data(name));
    EXPECT_EQ(error.code, Errc::kImportFailed);
    EXPECT_TRUE(has(error.detail, "a.gltf: primitive 0 of mesh 'a': user data of faces '" +
                                      std::string(name) +
                                      "': expected an integer of 32 bits, found " + found +
                                      " in the extras of its mesh"));
  }
}

TEST_F(UserDataTest, OfGltfWithoutMeshesIsNotTheFault) {
  EXPECT_EQ(fail("a.gltf", GltfText().text(R"({"name":"empty"})"), with_data("zone")).code,
            Errc::kNoFaces);
  EXPECT_EQ(fail("a.gltf", "{", with_data("zone")).code, Errc::kImportFailed);
}

TEST_F(UserDataTest, TellsMeshesOfOneShapeApart) {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  const auto scene = [&](const std::string& faces) {
    Result<SourceScene> read = import_scene(write("a.obj", points + faces), with_data("groups"));
    EXPECT_TRUE(read.ok());
    return std::move(read).value().meshes.front();
  };
  const SceneMesh one = scene("f 1 2 3\nf 1 3 4\n"), two = scene("f 1 2 3\ng a\nf 1 3 4\n");
  EXPECT_FALSE(has_same_shape(one, two));
  EXPECT_TRUE(has_same_shape(two, scene("g b\nf 1 2 3\ng c\nf 1 3 4\n")));
}

}  // namespace
}  // namespace boxtree::cooker
