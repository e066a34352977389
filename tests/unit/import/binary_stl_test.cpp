// SPDX-License-Identifier: MIT
// Our reader of binary STL against assimp's reader of the same mesh as text.
#include <array>
#include <cstring>
#include <limits>
#include <random>
#include <sstream>

#include "temp_files.h"

namespace boxtree::cooker {
namespace {

using BinaryStlTest = ImportTest;
using Triangle = std::array<std::array<float, 3>, 3>;

std::string binary(const std::vector<Triangle>& triangles, const std::string& title = "") {
  std::string file = title + std::string(80 - title.size(), '\0');
  const auto put = [&file](const auto& value) {
    file.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  put(static_cast<std::uint32_t>(triangles.size()));
  for (const Triangle& triangle : triangles) {
    put(std::array<float, 3>{});
    put(triangle);
    put(std::uint16_t{0x8001});
  }
  return file;
}

std::string text(const std::vector<Triangle>& triangles) {
  std::ostringstream file;
  file << "solid x\n";
  for (const Triangle& triangle : triangles) {
    file << "facet normal 0 0 0\nouter loop\n";
    for (const auto& corner : triangle) {
      file << "vertex " << corner[0] << ' ' << corner[1] << ' ' << corner[2] << '\n';
    }
    file << "endloop\nendfacet\n";
  }
  file << "endsolid x\n";
  return file.str();
}

// Coordinates that text holds without rounding, many of them equal, some triangles without area.
std::vector<Triangle> random_triangles(unsigned seed, std::size_t count) {
  std::mt19937 random(seed);
  std::vector<Triangle> triangles(count);
  for (Triangle& triangle : triangles) {
    for (auto& corner : triangle) {
      for (float& value : corner) value = static_cast<float>(random() % 9) / 4 - 1;
    }
  }
  if (count > 3) triangles[3][2] = triangles[3][0];
  return triangles;
}

TEST_F(BinaryStlTest, ReadsWhatAssimpReads) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const std::vector<Triangle> triangles = random_triangles(seed, 300);
    const ImportOptions options{.precision = seed % 2 == 0 ? Precision::kF32 : Precision::kF64};
    // Titles may claim to be text.
    const Imported got = load("a.stl", binary(triangles, seed % 3 == 0 ? "solid" : ""), options);
    const Imported expected = load("b.stl", text(triangles), options);
    expect_invariants(got);
    EXPECT_EQ(got.mesh.positions.f32, expected.mesh.positions.f32);
    EXPECT_EQ(got.mesh.positions.f64, expected.mesh.positions.f64);
    ASSERT_EQ(got.mesh.faces.size(), expected.mesh.faces.size());
    for (std::size_t i = 0; i < got.mesh.faces.size(); ++i) {
      ASSERT_EQ(got.mesh.faces[i].corner, expected.mesh.faces[i].corner);
    }
    EXPECT_TRUE(got.mesh.face_ids.empty());
    EXPECT_EQ(got.report.meshes, 1u);
    EXPECT_EQ(got.report.source_vertices, expected.report.source_vertices);
    EXPECT_EQ(got.report.vertices_welded, expected.report.vertices_welded);
    EXPECT_EQ(got.report.degenerate_faces, expected.report.degenerate_faces);
    EXPECT_GT(got.report.degenerate_faces, 0u);
  }
}

TEST_F(BinaryStlTest, SignsOfZeroStayApart) {
  const Imported got =
      load("a.stl",
           binary({{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, {{{-0.0f, 0, 0}, {1, 0, 0}, {0, 1, 0}}}}));
  EXPECT_EQ(got.mesh.positions.size(), 4u);
  EXPECT_EQ(got.report.vertices_welded, 2u);
}

TEST_F(BinaryStlTest, LongerThanABuffer) {
  const std::vector<Triangle> triangles = random_triangles(5, 20'001);
  const Imported got = load("a.stl", binary(triangles));
  expect_invariants(got);
  EXPECT_EQ(got.mesh.faces.size(), triangles.size());
  EXPECT_EQ(got.mesh.positions.size(), 9u * 9 * 9);
}

TEST_F(BinaryStlTest, NotFiniteNamesVertexAndFace) {
  std::vector<Triangle> triangles = random_triangles(1, 5);
  triangles[2][1][0] = std::numeric_limits<float>::quiet_NaN();
  triangles[2][1][1] = 0.5f;
  triangles[2][1][2] = -std::numeric_limits<float>::infinity();
  const Error error = fail("a.stl", binary(triangles));
  EXPECT_EQ(error.code, Errc::kMeshNotFinite);
  EXPECT_TRUE(has(error.detail, "face 2: vertex 7 is not finite: (nan, 0.5, -inf)"));
  const Imported rest = load("a.stl", binary(triangles), {.skip_bad = true});
  expect_invariants(rest);
  EXPECT_EQ(rest.mesh.face_ids, (std::vector<std::uint32_t>{0, 1, 3, 4}));
  EXPECT_EQ(rest.report.vertices_unused, 3u);
  triangles = {triangles[2]};
  EXPECT_TRUE(has(fail("a.stl", binary(triangles), {.skip_bad = true}).detail, "its only face is bad"));
}

// Its letters were read as a count.
TEST_F(BinaryStlTest, ATextOfAnotherFormatIsToldSo) {
  const std::string obj = "# an OBJ\n" + std::string(100, ' ') + "\nv 0 0 0\n";
  EXPECT_TRUE(has(fail("a.stl", obj).detail,
                  "a.stl: no STL file: a text that does not begin with 'solid'"));
}

TEST_F(BinaryStlTest, LengthMustFitTheCount) {
  const std::string file = binary(random_triangles(1, 3));
  for (const bool is_cut : {false, true}) {
    const std::string wrong = is_cut ? file.substr(0, file.size() - 1) : file + "x";
    const Error error = fail("a.stl", wrong);
    EXPECT_EQ(error.code, Errc::kImportFailed);
    EXPECT_TRUE(has(error.detail, "3 triangles take 234 bytes, but the file has "));
    EXPECT_EQ(bool(has(error.detail, ", as if the file was cut short")), is_cut);
  }
  std::string huge = file;
  std::memset(huge.data() + 80, 0xff, 4);
  EXPECT_TRUE(has(fail("a.stl", huge).detail, "4294967295 triangles take 214748364834 bytes"));
  EXPECT_EQ(fail("a.stl", binary({})).code, Errc::kNoFaces);
}

}  // namespace
}  // namespace boxtree::cooker
