// SPDX-License-Identifier: MIT
// Spellings of text formats behind which readers lose statements, and texts that were cut short.
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cooker/import/source_scene.h"
#include "temp_files.h"

namespace boxtree::cooker {
namespace {

class TextFormatTest : public ImportTest {
 protected:
  // One triangle with these corners.
  void expect_triangle(const std::string& name, std::string_view text,
                       const std::array<Eigen::Vector3d, 3>& corners) const {
    const Imported got = load(name, text);
    ASSERT_EQ(got.mesh.faces.size(), 1u) << text;
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(got.mesh.positions[got.mesh.faces[0].corner[i]], corners[i]) << text;
    }
  }
  const std::array<Eigen::Vector3d, 3> corners_{Eigen::Vector3d(0, 0, 0), {1, 0, 0}, {0, 1, 0}};
};

TEST_F(TextFormatTest, AByteOrderMarkHidesNoVertex) {
  expect_triangle("a.obj", "\xef\xbb\xbfv 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
                  {Eigen::Vector3d(9, 9, 9), {0, 0, 0}, {1, 0, 0}});
  const Error inside = fail("b.obj", "v 0 0 0\nv 1 0 0\n\xef\xbb\xbfv 0 1 0\nf 1 2 1\n");
  EXPECT_EQ(inside.code, Errc::kImportFailed);
  EXPECT_TRUE(has(inside.detail, "line 3: no statement of OBJ begins with"));
}

TEST_F(TextFormatTest, IndentationHidesNoStatement) {
  for (const std::string blank : {" ", "\t", "  \t "}) {
    expect_triangle("a.obj", "v 0 0 0\n" + blank + "v 1 0 0\nv 0 1 0\n" + blank + "f 1 2 3\n",
                    corners_);
  }
  const Imported two = load("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n f 1 3 2\n");
  EXPECT_EQ(two.mesh.faces.size(), 2u);
}

TEST_F(TextFormatTest, LineEndsOfAllSystems) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string text;
    for (const char* line : {"v 0 0 0", "# a comment", "", "v 1 0 0", "v 0 1 0", "f 1 2 3"}) {
      text += line + end;
    }
    expect_triangle("a.obj", text, corners_);
    expect_triangle("b.obj", text + '\x1a', corners_);
  }
}

TEST_F(TextFormatTest, CommentsEndWithTheirLine) {
  expect_triangle("a.obj", "# C:\\models\\\nv 0 0 0\nv 1 0 0 # here\\\nv 0 1 0#3\nf 1 2 3 # 4\\\n",
                  corners_);
  expect_triangle("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n#\\\nf 1 2 3#4\n#", corners_);
}

TEST_F(TextFormatTest, BackslashesJoinLines) {
  for (const std::string end : {"\n", "\r\n"}) {
    expect_triangle("a.obj",
                    "v 0 \\" + end + "0 0" + end + "v 1 0 0" + end + "v\\" + end + "0 1\\" + end +
                        " 0" + end + "f 1 \\" + end + "2\\" + end + " 3" + end,
                    corners_);
  }
}

TEST_F(TextFormatTest, WhatLooksLikeAStatementIsOneOrRefused) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_TRUE(has(fail("a.obj", "V 0 0 0\n" + vertices + "f 1 2 3\n").detail, "line 1:"));
  EXPECT_TRUE(has(fail("b.obj", vertices + "f 1 2 3\nF 1 3 2\n").detail, "line 5:"));
  EXPECT_TRUE(has(fail("c.obj", vertices + "f 1 2 3\n\vf 1 3 2\n").detail, "line 5:"));
  EXPECT_EQ(fail("d.obj", vertices + "f 1 2 3x\n").code, Errc::kMeshIndexOutOfRange);
  EXPECT_EQ(fail("e.obj", vertices + "f 1 2 3.5\n").code, Errc::kMeshIndexOutOfRange);
}

const std::string kPly =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nelement face 3\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 1 3\n4 0 2 3 1\n";

TEST_F(TextFormatTest, PlyHasEveryElementThatItStates) {
  const std::string body = kPly.substr(0, kPly.find("3 0 1 3"));
  const Error one = fail("a.ply", body);
  EXPECT_EQ(one.code, Errc::kImportFailed);
  EXPECT_TRUE(has(one.detail, "the file ends after 1 of 3 'face'"));
  const Error corner = fail("b.ply", body + "3 0 1 3\n4 0 2\n");
  EXPECT_TRUE(has(corner.detail, "a list of '4' numbers, but the line has 3 words"));
  EXPECT_TRUE(has(fail("c.ply", body + "3 0 1 3\n4 0 2 3\n").detail, "'face' 2 has 4 words"));
  EXPECT_TRUE(has(fail("d.ply", body + "3 0 1 3\n4 0 2 3 1 3 0 1 2\n").detail,
                  "'face' 2 has 9 words; its properties take 5"));
  EXPECT_TRUE(has(fail("e.ply", body + "3 0 1 3\nx 0 2 3\n").detail, "a list of 'x' numbers"));
  std::string carriage_returns = kPly;
  std::replace(carriage_returns.begin(), carriage_returns.end(), '\n', '\r');
  EXPECT_EQ(load("f.ply", carriage_returns).mesh.faces.size(),
            load("g.ply", kPly).mesh.faces.size());
}

const std::string kStl =
    "solid a facet\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n"
    "   vertex 0 1 0\n  endloop\n endfacet\n facet normal 0 0 1 outer loop vertex 1 0 0\n"
    "vertex 1 1 0 vertex 0 1 0 endloop endfacet\nendsolid a facet\n";

TEST_F(TextFormatTest, StlClosesEveryFacetAndSolid) {
  EXPECT_EQ(load("a.stl", kStl).mesh.faces.size(), 2u);
  EXPECT_EQ(load("b.stl", kStl + kStl).mesh.faces.size(), 4u);
  const Error open = fail("c.stl", kStl.substr(0, kStl.find("endsolid")));
  EXPECT_EQ(open.code, Errc::kImportFailed);
  EXPECT_TRUE(has(open.detail, "the file ends without 'endsolid'"));
  EXPECT_TRUE(has(fail("d.stl", kStl.substr(0, kStl.find("vertex 0 1 0"))).detail,
                  "the file ends within a facet"));
  std::string two = kStl;
  two.erase(two.find("   vertex 1 0 0\n"), 16);
  EXPECT_TRUE(has(fail("e.stl", two).detail, "a facet of 2 corners"));
  std::string word = kStl;
  word.replace(word.find("vertex 1 1 0"), 12, "vertex 1 l 0");
  EXPECT_TRUE(has(fail("f.stl", word).detail, "'l' is no number"));
}

// All that follows was found by tests/import_oracle.

const std::string kThreeVertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const std::string kPlyBody = "0 0 0\n1 0 0\n0 1 0\n";

std::string ply_of(const std::string& vertex, const std::string& behind = "") {
  return "ply\nformat ascii 1.0\n" + vertex + "element face 1\n" + behind +
         "property list uchar int vertex_indices\nend_header\n";
}

TEST_F(TextFormatTest, CommentsInHeadersOfPlyEndNoElement) {
  const std::string xyz =
      "property float x\ncomment C:\\\nproperty float y\nobj_info 7\nproperty "
      "float z\n";
  expect_triangle(
      "a.ply",
      ply_of("element vertex 3\ncomment first\n" + xyz, "comment here\n") + kPlyBody + "3 0 1 2\n",
      corners_);
}

TEST_F(TextFormatTest, OtherElementsOfPlyAreNoVertices) {
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  const std::string camera = "element camera 2\nproperty float view\nproperty list uchar int a\n";
  const std::string rows = "7 2 8 9\n-1 0\n";
  expect_triangle("a.ply",
                  ply_of(camera + "element vertex 3\n" + xyz) + rows + kPlyBody + "3 0 1 2\n",
                  corners_);
  expect_triangle("b.ply",
                  ply_of("element vertex 3\n" + xyz + camera) + kPlyBody + rows + "3 0 1 2\n",
                  corners_);
}

TEST_F(TextFormatTest, TheLastNumberOfPlyEndsWithTheFile) {
  const std::string xyz = "property short x\nproperty short y\nproperty short z\n";
  expect_triangle("a.ply", ply_of("element vertex 3\n" + xyz) + kPlyBody + "3 0 1 2", corners_);
}

TEST_F(TextFormatTest, ListsAmongCoordinatesOfPlyHideNone) {
  const std::string xyz =
      "property float x\nproperty list uchar int seen\nproperty float y\nproperty float z\n";
  expect_triangle("a.ply",
                  ply_of("element vertex 3\n" + xyz) + "0 0 0 0\n1 2 7 8 0 0\n0 1 9 1 0\n3 0 1 2\n",
                  corners_);
}

TEST_F(TextFormatTest, NumbersBeyondFloatsAreNotFinite) {
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  const std::string body = "0 0 730000000000000000000000000000000000000\n1 0 0\n0 1 0\n3 0 1 2\n";
  EXPECT_EQ(fail("a.ply", ply_of("element vertex 3\n" + xyz) + body).code, Errc::kMeshNotFinite);
  EXPECT_EQ(fail("b.obj", "v 0 0 1e99999\n" + kThreeVertices + "f 1 2 3\n").code,
            Errc::kMeshNotFinite);
  // ... and those too small for them are zero.
  expect_triangle("c.obj",
                  "v 0 1e-99999 0." + std::string(6000, '0') + "1\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
                  corners_);
}

TEST_F(TextFormatTest, NumbersEndWhereTheirWordsDo) {
  for (const char* word : {"1.0f", "1,5", "0x10", "1.2.3", "1-2", "1\\2", "--1", "+-1", "1e"}) {
    const std::string text = std::string("v ") + word + " 0 0\n" + kThreeVertices + "f 1 2 3\n";
    EXPECT_TRUE(has(fail("a.obj", text).detail, "is no number")) << word;
  }
  EXPECT_TRUE(
      has(fail("b.off", "OFF\n3 1 0\n0 0 9\\.6\n1 0 0\n0 1 0\n3 0 1 2\n").detail, "is no number"));
}

TEST_F(TextFormatTest, CornersOfObjAreNumbersHoweverSpelled) {
  for (const char* face : {"f 01 +2 03", "f -03 -2 3", "f +1 2/ 3//", "f 1/9/9 2/-9/9 3/9/-9"}) {
    expect_triangle("a.obj", kThreeVertices + "vt 0 0\nvn 0 0 1\n" + face + "\n", corners_);
  }
  EXPECT_EQ(fail("b.obj", kThreeVertices + "f 1 2//1 3//-\x12\n").code, Errc::kMeshIndexOutOfRange);
  EXPECT_EQ(fail("c.obj", kThreeVertices + "f 1 2 3\nf -inf 2\n").code, Errc::kMeshIndexOutOfRange);
}

TEST_F(TextFormatTest, CommentsBehindNormalsEndWithTheirLine) {
  for (const char* statement : {"vn 0 0 1 # C:\\", "vt 0 0 # C:\\", "s 1 # C:\\"}) {
    expect_triangle("a.obj", kThreeVertices + statement + "\nf 1 2 3\n", corners_);
  }
}

// Found by a newcomer: "fo", the name of "f" in files of version 2, was no face.
TEST_F(TextFormatTest, OldFacesOfObjAreFaces) {
  const Imported got = load("a.obj", kThreeVertices + "fo 1 2 3 # a\nfo 1 3 \\\n2\nf 2 3 1\n");
  EXPECT_EQ(got.mesh.faces.size(), 3u);
  EXPECT_TRUE(got.report.unread.empty());
  EXPECT_EQ(load("b.obj", kThreeVertices + "f 1 2 3\nfoo 1 3 2\nfo\n").mesh.faces.size(), 1u);
}

// Found by a newcomer: free-form surfaces and unknown statements were lost in silence.
TEST_F(TextFormatTest, StatementsOfObjThatAreNotReadAreReported) {
  const Imported got =
      load("a.obj", kThreeVertices +
                        "vt 0 0\nvn 0 0 1\nvp 0\ng a\no a\ns 1\nmg 1 2\nusemtl a\nlod 1\n"
                        "f 1 2 3\nl 1 2\np 1\ncstype bezier\ndeg 1\nsurf 0 1 0 1 1 2 3\nend\n"
                        "surf 0 1 0 1 \\\n1 2 3\nface 1 2 3\nend");
  std::vector<std::string> found;
  for (const Unread& part : got.report.unread) {
    found.push_back(fmt::format("{} {} {}", part.what, part.count, part.line));
  }
  EXPECT_EQ(found, (std::vector<std::string>{"cstype 1 16", "deg 1 17", "surf 2 18", "end 2 19",
                                             "face 1 22"}));
}

TEST_F(TextFormatTest, FewStatementsOfObjThatAreNotReadAreListed) {
  std::string text = kThreeVertices + "f 1 2 3\n";
  for (int i = 0; i < 100; ++i) text += fmt::format("x{}\nx0\n", i);
  const std::vector<Unread> unread = load("a.obj", text).report.unread;
  ASSERT_EQ(unread.size(), 33u);
  EXPECT_EQ(unread[0].count, 101u);
  EXPECT_EQ(unread[31].what, "x31");
  EXPECT_EQ(unread[32].what, "other statements");
  EXPECT_EQ(unread[32].count, 68u);
  EXPECT_EQ(unread[32].line, 5u + 2 * 32);
}

// Found by a newcomer: the faces of another file were lost in silence.
TEST_F(TextFormatTest, CallsOfObjAreRefused) {
  const Error error = fail("a.obj", kThreeVertices + "f 1 2 3\ncall other.obj\n");
  EXPECT_EQ(error.code, Errc::kImportFailed);
  EXPECT_TRUE(has(error.detail, "line 5: 'call' reads another file here, other.obj; write the"));
}

// Found by a newcomer: faces beyond the count of the header were lost in silence. Blank lines,
// comments, blanks and zero bytes are none.
TEST_F(TextFormatTest, WhatFollowsTheLastElementIsReported) {
  const auto left_over = [this](const std::string& name, const std::string& text) {
    const std::vector<Unread> unread = load(name, text).report.unread;
    EXPECT_LE(unread.size(), 1u);
    return unread.empty()
               ? std::string()
               : fmt::format("{} {} {}", unread[0].count, unread[0].what, unread[0].line);
  };
  const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n";
  EXPECT_EQ(left_over("a.off", off), "");
  EXPECT_EQ(left_over("a.off", off + "\n# 3 0 2 1\n \t\r\n"), "");
  EXPECT_EQ(left_over("a.off", off + "\n3 0 2 1\n# a\n3 0 2 1"),
            "2 lines after the last element 8");
  const std::string ply =
      ply_of("element vertex 3\nproperty float x\nproperty float y\nproperty float z\n") +
      kPlyBody + "3 0 1 2\n";
  EXPECT_EQ(left_over("a.ply", ply), "");
  EXPECT_EQ(left_over("a.ply", ply + "\n \n"), "");
  EXPECT_EQ(left_over("a.ply", ply + "3 0 2 1\n"), "1 lines after the last element 14");
  std::string binary =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty char x\n"
      "property char y\nproperty char z\nelement face 1\n"
      "property list uchar uchar vertex_indices\nend_header\n";
  binary += std::string("\0\0\0\1\0\0\0\1\0", 9) + std::string("\3\0\1\2", 4);
  EXPECT_EQ(left_over("a.ply", binary), "");
  EXPECT_EQ(left_over("a.ply", binary + std::string("\r\n \0\0", 5)), "");
  EXPECT_EQ(left_over("a.ply", binary + std::string("\3\0\2\1", 4)),
            "4 bytes after the last element 0");
  EXPECT_EQ(left_over("a.ply", binary + std::string(1u << 20, '\0')),
            "1048576 bytes after the last element 0");
}

TEST_F(TextFormatTest, FacesBeforeTheFirstMaterialHaveNone) {
  const auto path = write("a.obj", kThreeVertices + "f 1 2 3\nusemtl red\nf 1 3 2\n");
  const Result<SourceScene> scene = import_scene(path);
  ASSERT_TRUE(scene.ok()) << scene.error().detail;
  ASSERT_EQ(scene->meshes.size(), 1u);
  const std::vector<FaceRun>& runs = scene->meshes[0].materials;
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_NE(scene->materials[runs[0].number], "red");
  EXPECT_EQ(scene->materials[runs[1].number], "red");
}

TEST_F(TextFormatTest, NumbersOfTextStlMayHaveAnyDigits) {
  const std::string one =
      "00000000000000000000000000000000000001.000000000000000000000000000000000000";
  const std::string facet = "SOLID x\nFacet normal 0 0 1\nouter loop\nvertex 0 0 0\nVERTEX " + one +
                            " 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
  expect_triangle("a.stl", facet + "endsolid x\n", corners_);
  EXPECT_TRUE(has(fail("b.stl", "solid x\nouter loop\nendloop\nendsolid\n").detail,
                  "line 2: 'outer' instead of 'facet' or 'endsolid'"));
}

TEST_F(TextFormatTest, NothingStandsBetweenFacetsOfStl) {
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
      "endfacet\n";
  const auto refused = [&](const std::string& text, const char* why) {
    EXPECT_TRUE(has(fail("a.stl", text).detail, why));
  };
  refused("solid x\n" + facet + "fcaet\nendsolid x\n", "'fcaet' instead of 'facet' or 'endsolid'");
  refused("solid x\n" + facet + "solid y\n" + facet + "endsolid\n", "'solid' instead of 'facet'");
  refused("solid x\nendsolid x\n" + facet, "'facet' instead of 'solid'");
  expect_triangle("b.stl", " \nsolid\n" + facet + "end solid\nsolid facet\nendsolid\n", corners_);
}

TEST_F(TextFormatTest, ZeroBytesAreNoText) {
  using namespace std::string_literals;
  EXPECT_TRUE(has(fail("a.obj", kThreeVertices + "f 1 2\0 3\n"s).detail, "line 4: a zero byte"));
  EXPECT_TRUE(has(fail("b.off", "OFF\n3 1 0\n0 0 0\0\n1 0 0\n0 1 0\n3 0 1 2\n"s).detail, "line 3"));
  expect_triangle("c.obj", kThreeVertices + "f 1 2 3\n\0\0\0"s, corners_);
}

TEST_F(TextFormatTest, VerticesOfOffHaveAllTheirNumbers) {
  const std::string faces = "3 0 1 2\n";
  // The second vertex takes its normal and texture from the lines that follow.
  EXPECT_TRUE(
      has(fail("a.off", "STNOFF\n3 1 0\n0 0 0 0 0 1 0 0\n1 0 0\n0 1 0 0 0 1 0 0\n" + faces).detail,
          "the file ends within a vertex"));
  EXPECT_TRUE(has(fail("b.off", "OFF\n3 1 0\n0 0 0 x\n1 0 0\n0 1 0\n" + faces).detail,
                  "line 3: 'x' is no number"));
}

TEST_F(TextFormatTest, LinesOfOffMeanNothingButBehindColors) {
  expect_triangle("a.off", "OFF 3\n1 0 0 0 0 1\n0 0 0 1 0\n3\n0 1\n2 0.5 0.5 0.5\n", corners_);
  expect_triangle("b.off", "COFF\n3 1\n0 0 0 1 0 0\n1 0 0 1 0 0\n0 1 0 1 0 0\n3 0 1 2", corners_);
  expect_triangle("c.off", "COFF\n3 1\n\n0 0 0 1 0\n0 1 1 0 0 1 0 0 1\n0 1 0 1 0 0 1\n3 0 1 2\n",
                  corners_);
  EXPECT_TRUE(has(fail("d.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 red\n").detail,
                  "line 6: 'red' behind a face is no number of a color"));
  const Error none = fail("e.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n0 1 1 1\n");
  EXPECT_EQ(none.code, Errc::kNoFaces);
  EXPECT_TRUE(has(none.detail, "1 face without corners"));
}

TEST_F(TextFormatTest, CornersOfObjHaveThreeNumbersAtMost) {
  for (const char* corner : {"1/1/1/1", "+-1", "1/x", "1//2/"}) {
    const Error error = fail("a.obj", kThreeVertices + "f " + corner + " 2 3\n");
    EXPECT_EQ(error.code, Errc::kMeshIndexOutOfRange) << corner;
    EXPECT_TRUE(has(error.detail, "corner 0 (line 4) says '" + std::string(corner) + "'"));
  }
}

// Objects and groups that are taken up again do not change the order of faces.
TEST_F(TextFormatTest, FacesOfObjKeepTheirOrder) {
  const Imported got = load("a.obj", kThreeVertices + "v 0 0 1\no a\nf 1 2 3\no b\nf 1 2 4\no a\n" +
                                         "usemtl x\nf 1 3 4\ng b\nf 4 3 2\n");
  ASSERT_EQ(got.mesh.faces.size(), 4u);
  const std::array<std::array<std::uint32_t, 3>, 4> expected = {
      {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {3, 2, 1}}};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(got.mesh.faces[i].corner[k], expected[i][k]);
  }
  EXPECT_EQ(got.report.meshes, 1u);
}

TEST_F(TextFormatTest, CarriageReturnsEndHeadersOfBinaryPly) {
  std::string ply =
      "ply\rformat binary_little_endian 1.0\relement vertex 3\rproperty uchar x\r"
      "property uchar y\rproperty uchar z\relement face 1\r"
      "property list uchar uchar vertex_indices\rend_header\r";
  ply += std::string("\0\0\0\1\0\0\0\1\0\3\0\1\2", 13);
  expect_triangle("a.ply", ply, corners_);
}

// Of each format a file of several faces, cut after every byte: refused, whole nevertheless, or
// said to end openly. An OBJ file states no counts: cut between lines it is another whole file.
TEST_F(TextFormatTest, EveryTruncationIsRefusedOrTold) {
  struct Sample {
    const char* name;
    std::string text;
    bool has_counts;
  };
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4 2\n";
  const std::string off = "OFF\n4 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 1 3\n4 0 2 3 1\n";
  for (const Sample& sample : {Sample{"a.obj", obj, false}, Sample{"a.off", off, true},
                               Sample{"a.ply", kPly, true}, Sample{"a.stl", kStl, true}}) {
    const std::size_t faces = load(sample.name, sample.text).mesh.faces.size();
    std::size_t told = 0, refused = 0;
    for (std::size_t size = 1; size < sample.text.size(); ++size) {
      const std::string cut = sample.text.substr(0, size);
      const Result<Imported> got = import_mesh(write(sample.name, cut));
      if (!got.ok()) {
        ++refused;
        continue;
      }
      told += got->report.has_open_end ? 1u : 0u;
      const bool is_whole = got->mesh.faces.size() == faces;
      const bool is_between_lines = !sample.has_counts && cut.back() == '\n';
      EXPECT_TRUE(got->report.has_open_end || is_whole || is_between_lines)
          << sample.name << " cut after " << size << " bytes";
    }
    EXPECT_GT(refused, sample.text.size() / 2) << sample.name;
    EXPECT_FALSE(load(sample.name, sample.text).report.has_open_end);
    EXPECT_EQ(told > 0, std::string_view(sample.name) != "a.stl") << sample.name;
  }
}

}  // namespace
}  // namespace boxtree::cooker
