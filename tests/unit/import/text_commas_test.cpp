// SPDX-License-Identifier: MIT
// Commas between digits end a number in XGL, X and X3D; assimp's readers would take them for
// decimal points.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cooker/import/import.h"
#include "placed_triangles.h"
#include "temp_files.h"

namespace boxtree::cooker {
namespace {

using Triangles = std::vector<PlacedTriangle>;

class TextCommas : public ImportTest {
 protected:
  Triangles read(const std::string& name, const std::string& text) const {
    const Result<Imported> imported = import_mesh(write(name, text));
    EXPECT_TRUE(imported.ok()) << imported.error().message();
    return imported.ok() ? placed_triangles(imported->mesh) : Triangles();
  }
};

TEST_F(TextCommas, OfX) {
  const std::string mesh = "Mesh m { 3; 1.0;2.0;3.0;,5.0;2.0;3.0;,1.0;7.0;3.0;; 1; 3;0,1,2;; }\n";
  const Triangles moved = read("moved.x",
                               "xof 0303txt 0032\nFrame R { FrameTransformMatrix {\n"
                               "1,0,0,0,0,1,0,0,0,0,1,0,10,20,30,1;; }\n" +
                                   mesh + "}\n");
  // X has z to the front, and is turned (docs/GUIDE.md, "What is read").
  EXPECT_EQ(moved, (Triangles{{std::array<float, 3>{11, 22, -33}, {11, 27, -33}, {15, 22, -33}}}));
}

TEST_F(TextCommas, OfX3d) {
  EXPECT_EQ(read("commas.x3d",
                 "<?xml version=\"1.0\"?><X3D version=\"3.0\"><Scene><Shape><IndexedFaceSet "
                 "coordIndex=\"0,1,2,-1\"><Coordinate point=\"1 2 3,5 2 3,1 7 3\"/>"
                 "</IndexedFaceSet></Shape></Scene></X3D>\n"),
            (Triangles{{std::array<float, 3>{1, 2, 3}, {5, 2, 3}, {1, 7, 3}}}));
}

TEST_F(TextCommas, OfXgl) {
  EXPECT_EQ(
      read("commas.xgl",
           "<WORLD><MESH ID=\"1\"><P ID=\"0\">1,2,3</P><P ID=\"1\">5,2,3</P><P ID=\"2\">1,7,3"
           "</P><N ID=\"0\">0,0,1</N><MAT ID=\"0\"><AMB>1,1,1</AMB><DIFF>1,1,1</DIFF><SPEC>"
           "0,0,0</SPEC></MAT><F><MATREF>0</MATREF><FV1><PREF>0</PREF><NREF>0</NREF></FV1>"
           "<FV2><PREF>1</PREF><NREF>0</NREF></FV2><FV3><PREF>2</PREF><NREF>0</NREF></FV3></F>"
           "</MESH><OBJECT><TRANSFORM><POSITION>0, 0, 0</POSITION></TRANSFORM><MESHREF>1"
           "</MESHREF></OBJECT></WORLD>"),
      (Triangles{{std::array<float, 3>{1, 2, 3}, {5, 2, 3}, {1, 7, 3}}}));
}

}  // namespace
}  // namespace boxtree::cooker
