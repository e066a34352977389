// SPDX-License-Identifier: MIT
// What import does to a mesh: numbering, polygons, transforms, welding, report.
#include <clocale>
#include <cmath>
#include <cstdlib>
#include <thread>

#include "temp_files.h"

namespace boxtree::cooker {
namespace {

using ImportMeshTest = ImportTest;
using MeshCorners = std::array<std::uint32_t, 4>;

TEST_F(ImportMeshTest, TriangleKeepsItsBits) {
  const Imported got = load("a.obj", "v 0.1 -0 1e-30\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  expect_invariants(got);
  EXPECT_EQ(got.mesh.name, "a");
  ASSERT_EQ(got.mesh.positions.f32.size(), 9u);
  EXPECT_EQ(got.mesh.positions.f32[0], 0.1f);
  EXPECT_TRUE(std::signbit(got.mesh.positions.f32[1]));
  EXPECT_EQ(got.mesh.faces[0].corner, (MeshCorners{0, 1, 2, kNoCorner}));
  EXPECT_TRUE(got.mesh.face_ids.empty());
  EXPECT_EQ(got.report.meshes, 1u);
}

TEST_F(ImportMeshTest, PolygonsKeepTheirNumbers) {
  const Imported got = load("a.obj",
                            "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 1 1\nv 0.5 2 0\n"
                            "f 1 2 3\n"      // 0: triangle
                            "f 1 2 3 4\n"    // 1: planar quad
                            "f 1 2 5 4\n"    // 2: bent quad
                            "l 1 2 3\n"      // two lines
                            "p 1\n"          // a point
                            "f 1 2 3 6 4\n"  // 3: five corners
                            "f 1 1 2\n"      // 4: no area
                            "f 1 3 3 1\n");  // 5: a quad without area
  expect_invariants(got);
  EXPECT_EQ(got.mesh.face_ids, (std::vector<std::uint32_t>{0, 1, 2, 2, 3, 3, 3, 4, 5}));
  EXPECT_EQ(got.mesh.triangle_count(), 11u);
  EXPECT_TRUE(got.mesh.faces[1].is_quad());
  EXPECT_EQ(got.report.source_faces, 6u);
  EXPECT_EQ(got.report.quads_kept, 2u);
  EXPECT_EQ(got.report.quads_split, 1u);
  EXPECT_EQ(got.report.ngons_split, 1u);
  EXPECT_EQ(got.report.degenerate_faces, 2u);
  EXPECT_EQ(got.report.lines_skipped, 2u);
  EXPECT_EQ(got.report.points_skipped, 1u);
}

TEST_F(ImportMeshTest, WeldsBitsAndKeepsTheOrderOfTheSource) {
  const Imported got = load("a.ply",
                            "ply\nformat ascii 1.0\nelement vertex 7\nproperty float x\n"
                            "property float y\nproperty float z\nelement face 2\n"
                            "property list uchar int vertex_indices\nend_header\n"
                            "9 9 9\n0 0 0\n1 0 0\n0 1 0\n1 0 0\n-0 0 0\n1 1 0\n"
                            "3 6 2 3\n3 4 1 5\n");
  expect_invariants(got);
  EXPECT_EQ(got.report.vertices_unused, 1u) << "9 9 9";
  EXPECT_EQ(got.report.vertices_welded, 1u) << "1 0 0";
  ASSERT_EQ(got.mesh.positions.size(), 5u) << "+0 and -0 differ";
  EXPECT_EQ(got.mesh.faces[0].corner, (MeshCorners{4, 1, 2, kNoCorner}));
  EXPECT_EQ(got.mesh.faces[1].corner, (MeshCorners{1, 0, 3, kNoCorner}));
}

// One triangle at (0,0,0) (1,0,0) (0,1,0), placed by two nodes under a parent.
std::string gltf(const std::string& nodes) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)" + nodes +
         R"(],"meshes":[{"name":"tri","primitives":[{"attributes":{"POSITION":0}}]}],)"
         R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",)"
         R"("min":[0,0,0],"max":[1,1,0]}],"bufferViews":[{"buffer":0,"byteLength":36}],)"
         R"("buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,)"
         R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
}

TEST_F(ImportMeshTest, InstancesAndNestedTransforms) {
  const std::string nodes =
      R"({"children":[1,2],"translation":[10,0,0]},{"mesh":0,"scale":[2,2,2]},)"
      R"({"mesh":0,"rotation":[0,0,1,0],"translation":[0,5,0]})";
  const Imported got = load("a.gltf", gltf(nodes));
  expect_invariants(got);
  EXPECT_EQ(got.report.meshes, 2u);
  EXPECT_EQ(got.report.source_faces, 2u);
  EXPECT_EQ(got.mesh.positions.f32,
            (std::vector<float>{10, 0, 0, 12, 0, 0, 10, 2, 0, 10, 5, 0, 9, 5, 0, 10, 4, 0}));
}

TEST_F(ImportMeshTest, MirroredInstanceStillFacesOutward) {
  const Imported got = load("a.gltf", gltf(R"({"mesh":0,"scale":[1,1,-1]})"));
  EXPECT_EQ(got.mesh.faces[0].corner, (MeshCorners{0, 2, 1, kNoCorner}));
}

TEST_F(ImportMeshTest, TransformsAreRoundedOnceToF32AndKeptInF64) {
  // 1 + 2^24 needs 25 bits.
  const std::string text = gltf(R"({"mesh":0,"translation":[16777216,0,0]})");
  const Imported narrow = load("a.gltf", text);
  EXPECT_EQ(narrow.mesh.positions.f32[3], 16777216.0f);
  EXPECT_EQ(narrow.report.vertices_welded, 1u) << "two corners fall together";
  EXPECT_EQ(narrow.report.degenerate_faces, 1u);
  const Imported wide = load("a.gltf", text, {.precision = Precision::kF64});
  expect_invariants(wide);
  ASSERT_EQ(wide.mesh.positions.f64.size(), 9u);
  EXPECT_EQ(wide.mesh.positions.f64[3], 16777217.0);
  EXPECT_EQ(wide.report.degenerate_faces, 0u);
}

TEST_F(ImportMeshTest, RotatedQuadsStayQuads) {
  const std::string box =
      "v -1 -2 -3\nv 1 -2 -3\nv 1 2 -3\nv -1 2 -3\nv -1 -2 3\nv 1 -2 3\nv 1 2 3\nv -1 2 3\n"
      "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  EXPECT_EQ(load("a.obj", box).report.quads_kept, 6u);
}

TEST_F(ImportMeshTest, ReportsTheFilesReadAndHashesTheirBytes) {
  const std::string obj = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n";
  write("a.mtl", "newmtl m\nKd 1 0 0\nmap_Kd missing.png\n");
  const Imported got = load("a.obj", obj);
  ASSERT_EQ(got.report.files_read.size(), 2u);
  EXPECT_EQ(got.report.files_read[0], folder_ / "a.obj");
  EXPECT_EQ(got.report.files_read[1], folder_ / "a.mtl");

  write("elsewhere/a.mtl", "newmtl m\nKd 1 0 0\nmap_Kd missing.png\n");
  EXPECT_EQ(load("elsewhere/a.obj", obj).report.content_hash, got.report.content_hash);
  write("a.mtl", "newmtl m\nKd 0 0 0\nmap_Kd missing.png\n");
  EXPECT_NE(load("a.obj", obj).report.content_hash, got.report.content_hash);
}

TEST_F(ImportMeshTest, ReportsMaterialLibrariesThatAreMissing) {
  write("there.mtl", "newmtl m\n");
  const Imported got = load("a.obj",
                            "mtllib gone.mtl there.mtl gone.mtl\nmtllib there.mtl\n"
                            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  ASSERT_EQ(got.report.files_read.size(), 2u);
  EXPECT_EQ(got.report.files_read[1], folder_ / "there.mtl");
  ASSERT_EQ(got.report.files_missing.size(), 1u);
  EXPECT_EQ(got.report.files_missing[0], folder_ / "gone.mtl");
}

TEST_F(ImportMeshTest, HashIsXxh3OfTheFile) {
  // printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' | xxhsum -H3
  const Imported got = load("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(got.report.content_hash, 0x51d6e4cecf31f00au);
}

TEST_F(ImportMeshTest, LocaleDoesNotMatter) {
  const std::string x3d =
      "<?xml version=\"1.0\"?><X3D><Scene><Shape><IndexedFaceSet coordIndex=\"0 1 2 -1\">"
      "<Coordinate point=\"0 0 0.5 1.5 0 0 0 1.25 0\"/></IndexedFaceSet></Shape></Scene></X3D>";
  const Imported plain = load("a.x3d", x3d);
  // One of the machine's, or made from its sources.
  if (std::setlocale(LC_ALL, "de_DE.UTF-8") == nullptr) {
    const std::string folder = folder_.string();
    const std::string make = "localedef -i de_DE -f UTF-8 '" + folder + "/de_DE.UTF-8'";
    ASSERT_EQ(std::system(make.c_str()), 0) << "needs the Debian package locales";
    ::setenv("LOCPATH", folder.c_str(), 1);
    ASSERT_NE(std::setlocale(LC_ALL, "de_DE.UTF-8"), nullptr);
  }
  EXPECT_STREQ(std::localeconv()->decimal_point, ",");
  const Imported comma = load("a.x3d", x3d);
  std::setlocale(LC_ALL, "C");
  EXPECT_EQ(comma.mesh.positions.f32, plain.mesh.positions.f32);
}

TEST_F(ImportMeshTest, ManyThreads) {
  const std::filesystem::path good = write("a.gltf", gltf(R"({"mesh":0})"));
  const std::filesystem::path bad = write("b.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  std::atomic<int> right = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] {
      for (int round = 0; round < 20; ++round) {
        right += import_mesh(good).ok() ? 1 : 0;
        right += import_mesh(bad).code() == Errc::kMeshNotFinite ? 1 : 0;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(right, 160);
}

}  // namespace
}  // namespace boxtree::cooker
