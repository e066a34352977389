// SPDX-License-Identifier: MIT
// What import refuses, and that the error says where; what skip_bad drops instead.
#include <sys/stat.h>

#include "format/container.h"
#include "temp_files.h"

namespace boxtree::cooker {
namespace {

using ImportErrorTest = ImportTest;

constexpr std::string_view kVerticesOfOne = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST_F(ImportErrorTest, FilesThatCannotBeRead) {
  const Result<Imported> missing = import_mesh(folder_ / "none.obj");
  EXPECT_EQ(missing.code(), Errc::kFileNotFound);
  EXPECT_TRUE(has(missing.error().detail, "none.obj"));

  const Result<Imported> folder = import_mesh(folder_);
  EXPECT_EQ(folder.code(), Errc::kFileUnreadable);
  EXPECT_TRUE(has(folder.error().detail, "directory"));

  const std::filesystem::path pipe = folder_ / "pipe.obj";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(import_mesh(pipe).code(), Errc::kFileUnreadable) << "and does not wait for a writer";

  const std::filesystem::path locked = write("locked.obj", "v 0 0 0\n");
  chmod(locked.c_str(), 0);
  if (geteuid() != 0) {
    EXPECT_EQ(import_mesh(locked).code(), Errc::kFileUnreadable);
  }

  EXPECT_EQ(import_mesh("").code(), Errc::kFileNotFound);
}

TEST_F(ImportErrorTest, FilesThatAreNoMesh) {
  const Error empty = fail("empty.obj", "");
  EXPECT_EQ(empty.code, Errc::kImportFailed);
  EXPECT_TRUE(has(empty.detail, "empty"));
  EXPECT_EQ(fail("a.xyz", "what is this").code, Errc::kImportFailed);
  EXPECT_EQ(fail("a.fbx", "Kaydara nonsense").code, Errc::kImportFailed);
  EXPECT_EQ(fail("a.stl", std::string(84, '\xff')).code, Errc::kImportFailed);
  EXPECT_EQ(fail("a.gltf", "{").code, Errc::kImportFailed);
  const Error token = fail("a.obj", "v 0 0 0\nv zero 0 0 0\nv 0 0 1\nf 1 1 1\n");
  EXPECT_EQ(token.code, Errc::kImportFailed);
  EXPECT_TRUE(has(token.detail, "line 2: 'zero' is no number"));
  // Assimp would leave the vertex out and give its number to the next.
  const Error two = fail("a.obj", "v 0 0 0\nv 1 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\nf 1 2 3\n");
  EXPECT_EQ(two.code, Errc::kImportFailed);
  EXPECT_TRUE(has(two.detail, "line 2: expected a vertex of 3 numbers, found 2"));
}

// Found by a newcomer: "no faces", or a message of assimp about a format that nobody meant.
TEST_F(ImportErrorTest, WhatIsNoMeshAtAllIsToldSo) {
  const std::string script = "#!/bin/sh\necho hello\n";
  EXPECT_TRUE(has(fail("script.obj", script).detail,
                  "script.obj: no faces: no line of it is a vertex or a face of OBJ"));
  for (const char* const name : {"script.sh", "script.txt", "script"}) {
    const Error error = fail(name, script);
    EXPECT_EQ(error.code, Errc::kImportFailed);
    EXPECT_TRUE(has(error.detail, "expected a mesh by its ending: .obj, .off, .ply, .stl, "));
  }
  EXPECT_TRUE(has(fail("script.sh", script).detail, "found .sh"));
  EXPECT_TRUE(has(fail("script", script).detail, "found none"));
  EXPECT_TRUE(has(fail("scene.toml", "[scene]\nf = 1\n").detail,
                  "found .toml; cook --profile takes a profile"));
  EXPECT_TRUE(has(fail("script.glb", script).detail,
                  "no reader knows how it begins; expected a file of the format .glb"));
  // Found by a newcomer: CAD was called binary data or a file schema of IFC.
  const std::string step =
      "ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n"
      "#1=CARTESIAN_POINT('',(0.,0.,0.));\nENDSEC;\nEND-ISO-10303-21;\n";
  for (const char* const name : {"part.step", "part.stp", "PART.STP"}) {
    EXPECT_TRUE(has(fail(name, step).detail,
                    "expected IFC, which of STEP alone has a reader; shapes of CAD have no faces "
                    "yet: mesh them, e.g. as .stl by gmsh or FreeCAD (IFC: Unrecognized file "
                    "schema: AUTOMOTIVE_DESIGN)"));
  }
  const std::string cooked(reinterpret_cast<const char*>(kMagic.data()), kMagic.size());
  for (const char* const name : {"cooked.bxt", "cooked.obj", "cooked"}) {
    EXPECT_TRUE(has(fail(name, cooked + "and more").detail,
                    "expected a mesh, found a cooked file, which info, verify, query, bench and "
                    "export take"));
  }
}

// Found by newcomers: a picture that is called .stl had 522937230 triangles, one called .obj a zero
// byte.
TEST_F(ImportErrorTest, WhatIsNoMeshIsToldSoWhateverItsEnding) {
  const std::string rest(200, '\1');
  const std::pair<std::string, const char*> files[] = {
      {"\x89PNG\r\n\x1a\n", "a picture (PNG)"},
      {"\xff\xd8\xff\xe0", "a picture (JPEG)"},
      {"GIF89a", "a picture (GIF)"},
      {std::string("II*\0", 4), "a picture (TIFF)"},
      {"RIFF1234WEBP", "a picture (WebP)"},
      {"%PDF-1.7\n", "a PDF document"},
      {"\x1f\x8b\x08", "a file that gzip compressed"},
      {"<!DOCTYPE HTML>\n", "a web page (HTML)"},
      {"version https://git-lfs.github.com/spec/v1\n", "a pointer of Git LFS, in the place"},
  };
  for (const auto& [start, what] : files) {
    for (const std::string ending : {"stl", "obj", "off", "ply", "glb", "fbx"}) {
      const Error error = fail("a." + ending, start + rest);
      EXPECT_EQ(error.code, Errc::kImportFailed);
      EXPECT_TRUE(has(error.detail, std::string("expected a mesh, found ") + what)) << ending;
    }
  }
  EXPECT_FALSE(has(fail("a.stl", "RIFF1234WAVE" + rest).detail, "picture"));
  EXPECT_FALSE(has(fail("a.obj", "RIFF").detail, "picture"));
}

// Found by a newcomer: of a binary PLY that is called .obj a zero byte was told.
TEST_F(ImportErrorTest, AMeshOfAnotherFormatIsToldByHowItBegins) {
  const std::string nothing(4, '\0');
  const std::pair<std::string, std::string> files[] = {
      {"ply\nformat binary_little_endian 1.0\nend_header\n" + nothing, ".ply"},
      {"glTF" + std::string("\2\0\0\0", 4) + nothing, ".glb"},
      {"OFF\n3 1 0\n" + nothing, ".off"},
      {"solid m\n" + nothing, ".stl"}};
  for (const auto& [content, meant] : files) {
    for (const std::string ending : {".obj", ".ply"}) {
      if (ending == meant) continue;
      const Error error = fail("a" + ending, content);
      EXPECT_TRUE(has(error.detail, "expected what " + ending +
                                        " files hold, found one that begins as " + meant +
                                        " files do: rename it to end in " + meant))
          << error.detail;
    }
    EXPECT_FALSE(has(fail("a" + meant, content).detail, "rename it to end"));
  }
}

// Found by a newcomer: assimp took it by its first bytes, without any of what our reader checks.
TEST_F(ImportErrorTest, AMeshThatAnotherReaderTakesIsRefused) {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  for (const std::string ending : {".gltf", ".glb"}) {
    const Error error = fail("a" + ending, obj);
    EXPECT_EQ(error.code, Errc::kImportFailed);
    EXPECT_TRUE(has(error.detail, "expected a file of the format " + ending +
                                      ", found one that assimp's \"Wavefront Object Importer\" "
                                      "takes: give it the ending of its format"))
        << error.detail;
  }
  const Error error = fail("a.glb",
                           "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty "
                           "float y\nproperty float z\nelement face 1\nproperty list uchar int "
                           "vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_TRUE(has(error.detail, "rename it to end in .ply")) << error.detail;
}

std::string ply(std::string_view vertices, std::string_view faces, int vertex_count,
                int face_count) {
  return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertex_count) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
         std::to_string(face_count) + "\nproperty list uchar int vertex_indices\nend_header\n" +
         std::string(vertices) + std::string(faces);
}

// Found by newcomers: a glTF file that was cut had no reader that "knows how it begins".
TEST_F(ImportErrorTest, ACutFileIsToldSo) {
  EXPECT_TRUE(has(fail("cut.gltf", "\n{\"asset\": {\"version\": \"2.0\"").detail,
                  "cut.gltf: its JSON ends within a value, after 28 bytes, as if the file was cut "
                  "short"));
  EXPECT_TRUE(has(fail("broken.gltf", "{\"asset\":\n{\"version\": \"2.0\"}, }").detail,
                  "broken.gltf: its JSON is broken in line 2, at byte 30 of 31"));
  EXPECT_TRUE(has(fail("no.gltf", "hello").detail, "no reader knows how it begins"));
  EXPECT_TRUE(has(fail("no.gltf", R"({"asset":{"version":"3.0"}})").detail,
                  "expected a file of the format .gltf, JSON from its first byte on with "
                  "\"version\": \"2.0\" of its asset"));
  // Found by newcomers: a text STL was "cut short", a PLY file "no PLY file".
  for (const char* name : {"mark.gltf", "mark.stl", "mark.ply", "mark.off"}) {
    EXPECT_TRUE(has(fail(name, "\xef\xbb\xbfsolid x\nendsolid x\n").detail,
                    "it begins with a byte order mark (EF BB BF)"))
        << fail(name, "\xef\xbb\xbfsolid x\nendsolid x\n").detail;
  }
  EXPECT_FALSE(has(fail("mark.dae", "\xef\xbb\xbf<COLLADA").detail, "byte order mark"));
  const std::string header("glTF\x02\0\0\0\x40\x06\0\0", 12);
  EXPECT_TRUE(has(fail("cut.glb", header.substr(0, 9)).detail,
                  "cut.glb: its header ends after 9 bytes, as if the file was cut short"));
  EXPECT_TRUE(has(fail("cut.glb", header + "and so on").detail,
                  "cut.glb: it has 21 bytes, but its header states 1600, as if the file was cut "
                  "short"));

  const std::string mesh = ply("0 0 0\n1 0 0\n0 1 0\n", "3 0 1 2\n3 0 2 1\n", 3, 2);
  const auto cut = [&](std::size_t bytes) {
    return fail("cut.ply", mesh.substr(0, mesh.size() - bytes)).detail;
  };
  EXPECT_TRUE(has(cut(8), "the file ends after 1 of 2 'face', as if the file was cut short"));
  EXPECT_TRUE(has(cut(4), "a list of '3' numbers, but the line has 2 words, as if the file was"));
  EXPECT_TRUE(has(cut(18), "'vertex' 2 has 2 words; its properties take 3, as if the file"));
  EXPECT_TRUE(has(cut(50), "the header has no 'end_header' behind it, as if the file was cut"));

  // The last word or line of a text without an end.
  const std::string obj(kVerticesOfOne);
  for (const char* const half : {"v 1", "v 1 2 -", "v 1 2 1e", "f 1 2 -", "f 1 2 3 -", "\1"}) {
    EXPECT_TRUE(has(fail("cut.obj", obj + "f 1 2 3\n" + half).detail, ", as if the file was cut"));
    EXPECT_FALSE(has(fail("a.obj", obj + "f 1 2 3\n" + half + "\n").detail, "cut short")) << half;
  }
  EXPECT_FALSE(has(fail("a.obj", obj + "f 1 2 9").detail, "cut short"));
  const std::string facet =
      "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
      "endloop\nendfacet\nendsolid x\n";
  for (std::size_t bytes = 6; bytes < facet.size() - 4; ++bytes) {
    EXPECT_TRUE(has(fail("cut.stl", facet.substr(0, bytes)).detail, ", as if the file was cut"))
        << facet.substr(0, bytes);
  }
  EXPECT_FALSE(has(fail("a.stl", "solid x\nfcaet\nendsolid x\n").detail, "cut short"));
  EXPECT_FALSE(has(fail("a.stl", "solid x\nfcaet \n").detail, "cut short"));
  // Not where lines follow.
  EXPECT_FALSE(has(fail("a.ply", ply("0 0\n1 0 0\n0 1 0\n", "3 0 1 2\n", 3, 1)).detail, "cut"));
}

// It was counted among points and lines.
TEST_F(ImportErrorTest, TheHalfFaceOfACutObjIsNoLine) {
  const std::string whole = std::string(kVerticesOfOne) + "f 1 2 3\nf 3 2 1\n";
  for (const std::size_t bytes : {2u, 4u, 5u}) {
    const Imported cut = load("cut.obj", whole.substr(0, whole.size() - 1 - bytes));
    EXPECT_EQ(cut.mesh.faces.size(), 1u) << bytes;
    EXPECT_TRUE(cut.report.has_half_face) << bytes;
    EXPECT_EQ(cut.report.lines_skipped + cut.report.points_skipped + cut.report.empty_skipped, 0u);
  }
  const Imported line = load("line.obj", std::string(kVerticesOfOne) + "f 1 2 3\nf 3 2\n");
  EXPECT_FALSE(line.report.has_half_face);
  EXPECT_EQ(line.report.lines_skipped, 1u);
}

TEST_F(ImportErrorTest, NoFaces) {
  EXPECT_EQ(fail("a.obj", "# nothing at all, but long enough\n").code, Errc::kNoFaces);
  const Error points = fail("points.obj", kVerticesOfOne);
  EXPECT_EQ(points.code, Errc::kNoFaces);
  EXPECT_TRUE(has(points.detail, "3 vertices that no face uses"));
  const Error lines = fail("lines.obj", std::string(kVerticesOfOne) + "l 1 2 3\n");
  EXPECT_EQ(lines.code, Errc::kNoFaces);
  EXPECT_TRUE(has(lines.detail, "2 lines"));
  EXPECT_EQ(fail("points.ply",
                 "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                 "property float y\nproperty float z\nend_header\n1 2 3\n")
                .code,
            Errc::kNoFaces);
}

TEST_F(ImportErrorTest, NotFiniteNamesVertexAndFace) {
  const std::string mesh = ply("0 0 0\n1 0 0\n0 1 0\nnan 0 0\n", "3 0 1 2\n3 0 3 2\n", 4, 2);
  const Error error = fail("a.ply", mesh, {.command = "cook"});
  EXPECT_EQ(error.code, Errc::kMeshNotFinite);
  EXPECT_TRUE(
      has(error.detail,
          "face 1: vertex 3 is not finite: (nan, 0, 0) (cook --skip-bad drops such faces)"));
  EXPECT_TRUE(fail("a.ply", mesh).detail.ends_with("face 1: vertex 3 is not finite: (nan, 0, 0)"));

  const Imported rest = load("a.ply", mesh, {.skip_bad = true});
  expect_invariants(rest);
  EXPECT_EQ(rest.report.source_faces, 2u);
  ASSERT_EQ(rest.report.skipped.size(), 1u);
  EXPECT_EQ(rest.report.skipped[0].face_id, 1u);
  EXPECT_TRUE(has(rest.report.skipped[0].reason, "vertex 3"));
}

TEST_F(ImportErrorTest, NotFiniteVertexThatNoFaceUsesIsHarmless) {
  const Imported got = load("a.ply", ply("inf nan 0\n0 0 0\n1 0 0\n0 1 0\n", "3 1 2 3\n", 4, 1));
  EXPECT_EQ(got.report.vertices_unused, 1u);
  EXPECT_EQ(got.mesh.positions.size(), 3u);
}

TEST_F(ImportErrorTest, OverflowIsNotFinite) {
  EXPECT_EQ(fail("a.obj", "v 1e39 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").code, Errc::kMeshNotFinite);
}

TEST_F(ImportErrorTest, IndexOutOfRangeInPly) {
  const std::string mesh = ply("0 0 0\n1 0 0\n0 1 0\n", "3 0 1 2\n3 0 1 3\n3 0 1 -1\n", 3, 3);
  const Error error = fail("a.ply", mesh);
  EXPECT_EQ(error.code, Errc::kMeshIndexOutOfRange);
  EXPECT_TRUE(has(error.detail, "face 1: corner 2 names vertex 3, but there are 3 vertices"));
  const Imported rest = load("a.ply", mesh, {.skip_bad = true});
  ASSERT_EQ(rest.report.skipped.size(), 2u);
  EXPECT_EQ(rest.report.skipped[1].face_id, 2u);
}

// Assimp refuses such OBJ files without a place, and numbers the vertices of OBJ files anew.
TEST_F(ImportErrorTest, ObjFaultsCountFromZeroAndQuoteTheFile) {
  const std::string obj = std::string(kVerticesOfOne) +
                          "v 0 0 nan\n"       // 4, line 4
                          "f 1 2 3\n"         // 0
                          "f 1/1/1 2 9/1\n"   // 1, line 6
                          "f 1 2 3 # text\n"  // 2
                          "f -2 -3 -5\n"      // 3, line 8
                          "f 0 1 2\n"         // 4, line 9
                          "f 1 2 \\\n 4\n"    // 5, two lines
                          "f -2 -3 -4\n"      // 6
                          "v 5 5 5\n";
  const Error error = fail("a.obj", obj);
  EXPECT_EQ(error.code, Errc::kMeshIndexOutOfRange);
  EXPECT_TRUE(has(error.detail,
                  "face 1: corner 2 (line 6) says '9/1', but OBJ counts the 5 vertices from 1"));
  // Found by a newcomer: 'x' was not one of the vertices.
  for (const std::string word : {"x", "3.5", "3/x", "99999999999999999999"}) {
    EXPECT_TRUE(has(fail("b.obj", std::string(kVerticesOfOne) + "f 1 2 " + word + "\n").detail,
                    "says '" + word + "', which is no number of a vertex"))
        << word;
  }

  const Imported rest = load("a.obj", obj, {.skip_bad = true});
  expect_invariants(rest);
  EXPECT_EQ(rest.report.source_faces, 7u);
  EXPECT_EQ(rest.mesh.face_ids, (std::vector<std::uint32_t>{0, 2, 6}));
  ASSERT_EQ(rest.report.skipped.size(), 4u);
  EXPECT_EQ(rest.report.skipped[1].face_id, 3u);
  EXPECT_TRUE(
      has(rest.report.skipped[1].reason, "(line 8) says '-5', but 4 vertices come before it"));
  EXPECT_TRUE(has(rest.report.skipped[2].reason, "counts the 5 vertices from 1"));
  EXPECT_EQ(rest.report.skipped[3].face_id, 5u);
  EXPECT_TRUE(has(rest.report.skipped[3].reason, "vertex 3 (line 4) is not finite"));
  EXPECT_EQ(rest.report.files_read.size(), 1u);
}

TEST_F(ImportErrorTest, NothingLeftIsNoFaces) {
  const Error error =
      fail("a.obj", std::string(kVerticesOfOne) + "f 1 2 4\nf 1 2 5\n", {.skip_bad = true});
  EXPECT_EQ(error.code, Errc::kNoFaces);
  EXPECT_TRUE(has(error.detail, "all 2 faces are bad"));
}

// Assimp would move the corner to the last vertex, drop the face of ten corners, and allocate.
TEST_F(ImportErrorTest, OffFaults) {
  const Error error = fail("a.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 7\n");
  EXPECT_EQ(error.code, Errc::kMeshIndexOutOfRange);
  EXPECT_TRUE(has(error.detail, "face 1: corner 2 (line 7) names vertex 7"));
  EXPECT_EQ(fail("b.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").code, Errc::kImportFailed);
  EXPECT_EQ(fail("c.off", "OFF\n4000000000 6 0\n0 0 0\n").code, Errc::kImportFailed);
  const Error infinite = fail("d.off", "OFF\n3 1 0\n0 0 inf\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_EQ(infinite.code, Errc::kMeshNotFinite);
  EXPECT_TRUE(has(infinite.detail, "vertex 0 (line 3)"));
}

TEST_F(ImportErrorTest, CountsOfPlyThatCannotBe) {
  const Error huge = fail("a.ply", ply("0 0 0\n", "3 0 0 0\n", 2'000'000'000, 1));
  EXPECT_EQ(huge.code, Errc::kImportFailed);
}

// Assimp drops faces with bad vertex numbers from glTF files: here one of two.
TEST_F(ImportErrorTest, GltfFacesThatAssimpDropsAreMissed) {
  const auto gltf = [](const std::string& indices, const std::string& other = "") {
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
           R"("meshes":[{"name":"tri","primitives":[{"attributes":{"POSITION":0},"indices":1}]})" +
           other +
           R"(],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",)"
           R"("min":[0,0,0],"max":[1,1,0]},)"
           R"({"bufferView":1,"componentType":5121,"count":6,"type":"SCALAR"}],)"
           R"("bufferViews":[{"buffer":0,"byteLength":36},{"buffer":1,"byteLength":6}],)"
           R"("buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,)"
           R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"},{"byteLength":6,)"
           R"("uri":"data:application/octet-stream;base64,)" +
           indices + R"("}]})";
  };
  EXPECT_EQ(load("good.gltf", gltf("AAECAAIB")).report.source_faces, 2u);  // 0 1 2  0 2 1
  const Error error = fail("bad.gltf", gltf("AAECAAIJ"));                  // 0 1 2  0 2 9
  EXPECT_EQ(error.code, Errc::kMeshIndexOutOfRange);
  EXPECT_TRUE(has(error.detail, "tri"));
  // What is left is what another mesh states, which no node has.
  const Error hidden =
      fail("hidden.gltf", gltf("AAECAAIJ", R"(,{"primitives":[{"attributes":{"POSITION":0}}]})"));
  EXPECT_EQ(hidden.code, Errc::kMeshIndexOutOfRange);
}

}  // namespace
}  // namespace boxtree::cooker
