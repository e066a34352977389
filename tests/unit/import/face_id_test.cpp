// SPDX-License-Identifier: MIT
// Ids of faces from a property of a PLY file, as the tiles of a world have them.
#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "temp_files.h"

namespace boxtree::cooker {
namespace {

using FaceIdTest = ImportTest;
using Ids = std::vector<std::uint32_t>;

ImportOptions with(const std::string& property) {
  ImportOptions options;
  options.face_ids = property;
  return options;
}

Ids ids_of(const Imported& imported) {
  Ids ids;
  for (std::size_t face = 0; face < imported.mesh.faces.size(); ++face) {
    ids.push_back(imported.mesh.face_id(face));
  }
  return ids;
}

std::string header(const std::string& form, const std::string& type, std::size_t faces) {
  return "ply\nformat " + form +
         " 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
         "property float z\nelement face " +
         std::to_string(faces) + "\nproperty list uchar int vertex_indices\nproperty " + type +
         " place\nend_header\n";
}

std::string text_ply(const std::string& type, const std::vector<std::string>& faces) {
  std::string text = header("ascii", type, faces.size());
  text += "0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 2 5\n";
  for (const std::string& face : faces) text += face + "\n";
  return text;
}

TEST_F(FaceIdTest, AreThosePropertiesOfFacesAndOfTheirParts) {
  const std::vector<std::string> faces = {"3 0 1 2 4",
                                          "2 0 1 7",      // no face
                                          "4 0 1 2 3 7",  // a quad that stays one
                                          "4 0 1 4 3 9",  // one that is not planar, split
                                          "3 1 2 4 2147483646"};
  EXPECT_EQ(ids_of(load("a.ply", text_ply("int", faces), with("place"))),
            (Ids{4, 7, 9, 9, 2147483646}));
  EXPECT_EQ(ids_of(load("a.ply", text_ply("int", faces))), (Ids{0, 1, 2, 2, 3}));
}

TEST_F(FaceIdTest, OfBinaryFilesHaveEitherByteOrder) {
  for (const bool is_big : {false, true}) {
    std::string file = header(is_big ? "binary_big_endian" : "binary_little_endian", "uint", 2);
    const auto add = [&](std::uint32_t word) {
      for (int i = 0; i < 4; ++i) {
        file += static_cast<char>(word >> 8 * (is_big ? 3 - i : i) & 0xff);
      }
    };
    for (const float x :
         {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 1.f, 0.f, 2.f, 2.f, 5.f})
      add(std::bit_cast<std::uint32_t>(x));
    for (const std::array<std::uint32_t, 4>& face :
         {std::array{0u, 1u, 2u, 258u}, std::array{0u, 2u, 3u, 70000u}}) {
      file += '\3';
      for (const std::uint32_t word : face) add(word);
    }
    EXPECT_EQ(ids_of(load("a.ply", file, with("place"))), (Ids{258, 70000}));
  }
}

TEST_F(FaceIdTest, AreSharedByPartsOfAFace) {
  const std::vector<std::string> faces = {"3 0 1 2 0", "3 0 2 3 0", "3 1 2 4 6", "3 0 1 4 6"};
  EXPECT_EQ(ids_of(load("a.ply", text_ply("int", faces), with("place"))), (Ids{0, 0, 6, 6}));
  ImportOptions both = with("place");
  both.user_data = "place";
  EXPECT_EQ(fail("a.ply", text_ply("int", faces), both).code, Errc::kMeshUnsupported);
}

TEST_F(FaceIdTest, ThatDescendAreRefused) {
  for (const auto& [first, second] : {std::pair("4", "3"), std::pair("-1", "3")}) {
    const Error error =
        fail("a.ply",
             text_ply("int", {"3 0 1 2 " + std::string(first), "3 0 2 3 " + std::string(second)}),
             with("place"));
    EXPECT_EQ(error.code, Errc::kMeshUnsupported) << error.detail;
    EXPECT_NE(error.detail.find("'place'"), std::string::npos) << error.detail;
  }
}

TEST_F(FaceIdTest, BeyondThoseOfAFileAreRefused) {
  const Error error = fail("a.ply", text_ply("uint", {"3 0 1 2 2147483647"}), with("place"));
  EXPECT_EQ(error.code, Errc::kMeshTooLarge) << error.detail;
  const Error words = fail("a.ply", text_ply("int", {"3 0 1 2 1.5"}), with("place"));
  EXPECT_EQ(words.code, Errc::kImportFailed) << words.detail;
}

TEST_F(FaceIdTest, ThatAFileDoesNotHaveAreRefused) {
  const Error missing = fail("a.ply", text_ply("int", {"3 0 1 2 5"}), with("plaice"));
  EXPECT_EQ(missing.code, Errc::kMeshUnsupported);
  EXPECT_NE(missing.detail.find("place"), std::string::npos) << missing.detail;
  const Error format = fail("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", with("place"));
  EXPECT_EQ(format.code, Errc::kMeshUnsupported);
  EXPECT_NE(format.detail.find("PLY"), std::string::npos) << format.detail;
}

}  // namespace
}  // namespace boxtree::cooker
