// SPDX-License-Identifier: MIT
// The same tetrahedron in the formats that people use most.
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <random>

#include <fmt/format.h>

#include "temp_files.h"

namespace boxtree::cooker {
namespace {

using ImportFormatTest = ImportTest;

constexpr std::array<std::array<float, 3>, 4> kVertices = {
    {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1.5f}}};
constexpr std::array<std::array<int, 3>, 4> kFaces = {{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};

void expect_tetrahedron(const Imported& got) {
  expect_invariants(got);
  ASSERT_EQ(got.mesh.positions.size(), 4u);
  ASSERT_EQ(got.mesh.faces.size(), 4u);
  EXPECT_TRUE(got.mesh.face_ids.empty());
  for (std::size_t face = 0; face < 4; ++face) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Eigen::Vector3d position = got.mesh.positions[got.mesh.faces[face].corner[corner]];
      const auto& expected = kVertices[static_cast<std::size_t>(kFaces[face][corner])];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(position[static_cast<int>(axis)], double{expected[axis]});
      }
    }
  }
}

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

TEST_F(ImportFormatTest, Obj) {
  expect_tetrahedron(load("a.obj",
                          "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nv 0 0 1.5\r\no x\r\nf 1 3 2\r\n"
                          "f 1 2 4\r\ng y\r\nf -3 -2 -1\r\nf 3 1 4"));
}

// Weights, colours, colours with opacity, comments, no digit before the point: assimp leaves the
// last three kinds out, and with them every number after.
TEST_F(ImportFormatTest, ObjVertexForms) {
  expect_tetrahedron(load("a.obj",
                          "v 0 0 0 0.1 0.2 0.3 1\nv 2 0 0 2\nv .0 1 0 0.5 0.5 0.5\n"
                          "v 0 0 1.5 # a comment of 2 numbers, 3\n"
                          "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"));
}

TEST_F(ImportFormatTest, OffWithColoursAndComments) {
  expect_tetrahedron(load("a.off",
                          "OFF # a comment\n\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1.5\n3 0 2 1\n"
                          "3 0 1 3 255 0 0\n3 1 2 3\n3 2 0 3\n"));
  expect_tetrahedron(load("b.off",
                          "COFF 4 4 0\n0 0 0 1 1 1 1\n1 0 0 1 1 1 1\n0 1 0 1 1 1 1\n"
                          "0 0 1.5 1 1 1 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n"));
  expect_tetrahedron(load("c.off",
                          "4OFF\n4 4 0\n0 0 0 1\n2 0 0 2\n0 1 0 1\n0 0 3 2\n3 0 2 1\n3 0 1 3\n"
                          "3 1 2 3\n3 2 0 3\n"));
}

TEST_F(ImportFormatTest, OffFaceOfTwelveCorners) {
  std::string off = "OFF\n12 1 0\n";
  for (int i = 0; i < 12; ++i) {
    off += std::to_string(i) + " " + std::to_string(i * i) + " 0\n";
  }
  off += "12 0 1 2 3 4 5 6 7 8 9 10 11\n";
  const Imported got = load("a.off", off);
  EXPECT_EQ(got.mesh.faces.size(), 10u);
  EXPECT_EQ(got.report.ngons_split, 1u);
}

TEST_F(ImportFormatTest, PlyAsciiAndBinary) {
  const std::string head =
      "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n"
      "property list uchar int vertex_indices\nend_header\n";
  expect_tetrahedron(load("a.ply", "ply\nformat ascii 1.0\n" + head +
                                       "0 0 0\n1 0 0\n0 1 0\n0 0 1.5\n3 0 2 1\n3 0 1 3\n3 1 2 3\n"
                                       "3 2 0 3\n"));
  std::string binary = "ply\nformat binary_little_endian 1.0\n" + head;
  for (const auto& vertex : kVertices) {
    for (const float coordinate : vertex) append(binary, coordinate);
  }
  for (const auto& face : kFaces) {
    binary += '\3';
    for (const int corner : face) append(binary, corner);
  }
  expect_tetrahedron(load("b.ply", binary));
}

TEST_F(ImportFormatTest, StlAsciiAndBinary) {
  std::string ascii = "solid a\n", binary(80, ' ');
  append(binary, std::uint32_t{4});
  for (const auto& face : kFaces) {
    ascii += "facet normal 0 0 0\nouter loop\n";
    for (int i = 0; i < 3; ++i) append(binary, 0.0f);
    for (const int corner : face) {
      ascii += "vertex";
      for (const float coordinate : kVertices[static_cast<std::size_t>(corner)]) {
        ascii += ' ' + std::to_string(coordinate);
        append(binary, coordinate);
      }
      ascii += '\n';
    }
    ascii += "endloop\nendfacet\n";
    append(binary, std::uint16_t{0});
  }
  expect_tetrahedron(load("a.stl", ascii + "endsolid a\n"));
  expect_tetrahedron(load("b.stl", binary));
}

// Found by a newcomer: coordinates of Collada were turned by the up axis and scaled by the unit.
TEST_F(ImportFormatTest, ColladaHasTheCoordinatesOfTheFile) {
  const auto dae = [](const std::string& asset) {
    return "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
           "version=\"1.4.1\"><asset>" +
           asset +
           "</asset><library_geometries><geometry id=\"g\"><mesh><source id=\"p\">"
           "<float_array id=\"f\" count=\"9\">0 0 0 1 0 0 0 2 0</float_array><technique_common>"
           "<accessor source=\"#f\" count=\"3\" stride=\"3\"><param name=\"X\" type=\"float\"/>"
           "<param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor>"
           "</technique_common></source><vertices id=\"v\"><input semantic=\"POSITION\" "
           "source=\"#p\"/></vertices><triangles count=\"1\"><input semantic=\"VERTEX\" "
           "source=\"#v\" offset=\"0\"/><p>0 1 2</p></triangles></mesh></geometry>"
           "</library_geometries><library_visual_scenes><visual_scene id=\"s\"><node>"
           "<instance_geometry url=\"#g\"/></node></visual_scene></library_visual_scenes><scene>"
           "<instance_visual_scene url=\"#s\"/></scene></COLLADA>";
  };
  for (const char* asset : {"", "<up_axis>X_UP</up_axis>", "<up_axis>Y_UP</up_axis>",
                            "<unit name=\"inch\" meter=\"0.0254\"/><up_axis>Z_UP</up_axis>"}) {
    const Imported got = load("a.dae", dae(asset));
    EXPECT_EQ(got.mesh.positions[1], Eigen::Vector3d(1, 0, 0)) << asset;
    EXPECT_EQ(got.mesh.positions[2], Eigen::Vector3d(0, 2, 0)) << asset;
    EXPECT_EQ(got.report.moved_by_f32, 0) << asset;
  }
}

// Assimp's RAW reader loses the nodes of all groups but the last; their faces are taken over
// anyway.
TEST_F(ImportFormatTest, RawGroups) {
  const Imported got = load("a.raw", "first\n0 0 0 1 0 0 0 1 0\nsecond\n0 0 1 1 0 1 0 1 1\n");
  EXPECT_EQ(got.report.source_faces, 2u);
}

TEST_F(ImportFormatTest, Base64AndExternalBuffers) {
  const auto gltf = [](const std::string& uri) {
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
           R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
           R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],)"
           R"("bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":")" +
           uri + R"("}]})";
  };
  std::string bytes;
  for (const float value : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) append(bytes, value);
  write("a.bin", bytes);
  const Imported outside = load("a.gltf", gltf("a.bin"));
  const Imported inside = load(
      "b.gltf",
      gltf(
          "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"));
  EXPECT_EQ(outside.mesh.positions.f32, inside.mesh.positions.f32);
  ASSERT_EQ(outside.report.files_read.size(), 2u);
  EXPECT_EQ(outside.report.files_read[1], folder_ / "a.bin");
  EXPECT_EQ(inside.report.files_read.size(), 1u);
}

// Two vertices that f32 cannot tell apart, in every format whose digits are kept.
constexpr std::array<std::array<double, 3>, 4> kFine = {
    {{1000000.0000000001, 0.1, 0}, {1000000.0000000003, 0.1, 0}, {0, 1e39, -0.5}, {0, 0, 1e-300}}};

void expect_fine(const Imported& got) {
  expect_invariants(got);
  ASSERT_EQ(got.mesh.positions.precision, Precision::kF64);
  ASSERT_EQ(got.mesh.positions.size(), 4u);
  ASSERT_EQ(got.mesh.faces.size(), 2u);
  constexpr std::array<std::array<std::size_t, 3>, 2> kCorners = {{{0, 1, 2}, {1, 3, 2}}};
  for (std::size_t face = 0; face < 2; ++face) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Eigen::Vector3d position = got.mesh.positions[got.mesh.faces[face].corner[corner]];
      const auto& expected = kFine[kCorners[face][corner]];
      EXPECT_EQ(position, Eigen::Vector3d(expected[0], expected[1], expected[2]));
    }
  }
}

TEST_F(ImportFormatTest, AllDigitsOfObjAndOffInF64) {
  const ImportOptions options{.precision = Precision::kF64};
  expect_fine(load("a.obj",
                   "v 1000000.0000000001 0.1 0\nv 1000000.0000000003 0.1 0 # with a comment\n"
                   "g first\nv 0 2e39 -1 2\nf 1 2 3\ng second\nv 0 0 1e-300 0.5 0.5 0.5\n"
                   "f -3 -1 -2\n",
                   options));
  expect_fine(load("a.off",
                   "OFF\n4 2 0\n1000000.0000000001 0.1 0\n1000000.0000000003 0.1 0\n"
                   "0 1e39 -0.5\n0 0 1e-300\n3 0 1 2\n3 1 3 2\n",
                   options));
}

TEST_F(ImportFormatTest, BadVerticesAreNamedInF64) {
  const Error error =
      fail("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1e999 0\nf 1 2 3\n", {.precision = Precision::kF64});
  EXPECT_EQ(error.code, Errc::kMeshNotFinite);
  EXPECT_NE(error.detail.find("vertex 2 (line 3)"), std::string::npos) << error.detail;
}

// Decimals of every spelling and magnitude. Assimp multiplies by a power of ten that is rounded
// itself, and adds what is behind the point as one float: both are off by a unit now and then.
std::vector<std::string> decimals_of_all_kinds() {
  std::mt19937 random(5);
  std::vector<std::string> words = {"1.2345678e-05",
                                    "7.0064923216240854e-46",
                                    "7.1e-46",
                                    "1.1754943508222875e-38",
                                    "1e-60",
                                    "-1e-400",
                                    "+2.5E+3",
                                    "3.40282356e38",
                                    "16777217",
                                    "16777219.0000000000000000000000000001",
                                    "-0",
                                    "123456789012345678901234567890",
                                    ".1",
                                    "5."};
  while (words.size() < 3000) {
    const auto any = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    if (!std::isfinite(any)) continue;
    const int digits = static_cast<int>(random() % 20);
    words.push_back(random() % 2 == 0 ? fmt::format("{:.{}e}", any, digits)
                                      : fmt::format("{:.{}f}", std::fmod(any, 1e6f), digits));
  }
  return words;
}

float nearest_float(std::string_view word) {
  float nearest = 0;
  const std::size_t sign = word.starts_with('+') ? 1 : 0;
  const auto [end, error] = std::from_chars(word.data() + sign, word.data() + word.size(), nearest);
  // Beyond the range of f32 there are only numbers near zero here.
  if (error != std::errc()) nearest = word.starts_with('-') ? -0.0f : 0.0f;
  EXPECT_EQ(end, word.data() + word.size()) << word;
  return nearest;
}

TEST_F(ImportFormatTest, DecimalsAreRoundedOnceToF32) {
  const std::vector<std::string> words = decimals_of_all_kinds();
  const std::size_t count = words.size() / 3;
  std::string vertices, obj_faces, off_faces;
  for (std::size_t i = 0; i < count; ++i) {
    vertices += fmt::format("{} {} {}\n", words[3 * i], words[3 * i + 1], words[3 * i + 2]);
    off_faces += fmt::format("3 {} {} {}\n", i, (i + 1) % count, (i + 2) % count);
    obj_faces += fmt::format("f {} {} {}\n", i + 1, (i + 1) % count + 1, (i + 2) % count + 1);
  }
  std::string obj_vertices;
  for (std::size_t i = 0; i < count; ++i) {
    obj_vertices += fmt::format("v {} {} {}{}\n", words[3 * i], words[3 * i + 1], words[3 * i + 2],
                                i % 3 == 0 ? " 0.1 0.2 0.3" : "");
  }
  const std::string counts = fmt::format("{0} {0} 0\n", count);
  const std::string header = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {0}\nproperty float x\nproperty float y\n"
      "property float z\nelement face {0}\nproperty list uchar int vertex_indices\nend_header\n",
      count);
  for (const Imported& got : {load("a.obj", obj_vertices + obj_faces),
                              load("a.off", "OFF\n" + counts + vertices + off_faces),
                              load("a.ply", header + vertices + off_faces)}) {
    expect_invariants(got);
    ASSERT_EQ(got.mesh.faces.size(), count);
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t vertex = got.mesh.faces[i].corner[0];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(std::bit_cast<std::uint32_t>(got.mesh.positions.f32[3 * vertex + axis]),
                  std::bit_cast<std::uint32_t>(nearest_float(words[3 * i + axis])))
            << words[3 * i + axis];
      }
    }
  }
}

std::string fine_ply(const std::string& format) {
  std::string ply = "ply\nformat " + format +
                    " 1.0\ncomment x\nelement material 1\nproperty uchar red\n"
                    "element vertex 4\nproperty float nx\nproperty double x\n"
                    "property double y\nproperty double z\nelement face 2\n"
                    "property list uchar int vertex_indices\nend_header\n";
  const bool swapped = format == "binary_big_endian";
  const auto put = [&](auto value) {
    std::string bytes;
    append(bytes, value);
    if (swapped) std::reverse(bytes.begin(), bytes.end());
    ply += bytes;
  };
  put(std::uint8_t{7});
  for (const auto& vertex : kFine) {
    put(1.0f);
    for (const double coordinate : vertex) put(coordinate);
  }
  for (const auto& face : {std::array<std::int32_t, 3>{0, 1, 2}, {1, 3, 2}}) {
    put(std::uint8_t{3});
    for (const std::int32_t corner : face) put(corner);
  }
  return ply;
}

TEST_F(ImportFormatTest, AllDigitsOfPlyInF64) {
  const ImportOptions options{.precision = Precision::kF64};
  expect_fine(load("little.ply", fine_ply("binary_little_endian"), options));
  expect_fine(load("big.ply", fine_ply("binary_big_endian"), options));
  expect_fine(load("text.ply",
                   "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
                   "property double z\nelement face 2\nproperty list uchar int vertex_indices\n"
                   "end_header\n1000000.0000000001 0.1 0\n1000000.0000000003 0.1 0\n"
                   "0 1e39 -0.5\n0 0 1e-300\n3 0 1 2\n3 1 3 2\n",
                   options));
}

// A file that ends inside its vertices is for assimp to refuse, with or without f64.
TEST_F(ImportFormatTest, ShortPlyIsRefusedInF64) {
  const std::string ply = fine_ply("binary_little_endian");
  fail("short.ply", ply.substr(0, ply.find("end_header") + 40), {.precision = Precision::kF64});
}

}  // namespace
}  // namespace boxtree::cooker
