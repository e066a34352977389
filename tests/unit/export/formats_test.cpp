// SPDX-License-Identifier: MIT
// OBJ and GLB to the letter: digits, bytes, names, colours; and what is refused.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <random>

#include <assimp/fast_atof.h>
#include <gtest/gtest.h>

#include "cooker/export/obj_writer.h"
#include "exported.h"
#include "format/container.h"
#include "runtime/file/open_file.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "viewer_files.h"

namespace boxtree::cooker {
namespace {

using test::ViewedPart;

SourceMesh one_triangle() {
  SourceMesh mesh;
  mesh.name = "one";
  mesh.positions.f32 = {0, 0, 0, 1, 0, 0.1f, -0.0f, 2, 0.5f};
  mesh.faces = {{{0, 1, 2, kNoCorner}}};
  return mesh;
}

TEST(ExportObj, OneTriangleLiterally) {
  const test::TempFolder folder;
  const test::CookedTree cooked = test::cook_tree(one_triangle(), CodecId::kWide8);
  const auto path = export_one(folder, "out.obj", cooked.tree, {});
  EXPECT_EQ(test::read_text(path),
            "# boxtree 0.1.0\n"
            "o one\n"
            "g one_triangles\n"
            "v 0 0 0\n"
            "v 1 0 0.100000001\n"
            "v -0 2 0.5\n"
            "f 1 2 3\n"
            "g one_level_0\n"
            "v 0 0 0\n"
            "v 1 0 0\n"
            "v 0 2 0\n"
            "v 1 2 0\n"
            "v 0 0 0.5\n"
            "v 1 0 0.5\n"
            "v 0 2 0.5\n"
            "v 1 2 0.5\n"
            "l 4 5\nl 6 7\nl 8 9\nl 10 11\n"
            "l 4 6\nl 5 7\nl 8 10\nl 9 11\n"
            "l 4 8\nl 5 9\nl 6 10\nl 7 11\n");
}

TEST(ExportObj, DigitsGiveEachFloatBackAndKeepTheirOrder) {
  std::mt19937 random(1);
  for (int i = 0; i < 200000; ++i) {
    const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    if (!std::isfinite(value)) continue;
    const std::string digits = f32_digits(value);
    ASSERT_EQ(std::bit_cast<std::uint32_t>(std::strtof(digits.c_str(), nullptr)),
              std::bit_cast<std::uint32_t>(value))
        << digits;
    const float next = std::nextafter(value, INFINITY);
    if (std::isfinite(next)) {
      ASSERT_LT(std::strtod(digits.c_str(), nullptr),
                std::strtod(f32_digits(next).c_str(), nullptr));
    }
  }
  EXPECT_EQ(f32_digits(0.0f), "0");
  EXPECT_EQ(f32_digits(-0.0f), "-0");
  EXPECT_EQ(f32_digits(100), "100");
  EXPECT_EQ(f32_digits(-0.25f), "-0.25");
  EXPECT_EQ(f32_digits(1e-7f), "0.000000100000001");
  EXPECT_EQ(f32_digits(1e15f), "999999986991104");
  EXPECT_EQ(f32_digits(1e-8f), "9.99999994e-09");
}

// What assimp throws: its own errors are not to be linked with.
struct NotANumber {
  template <class... Words>
  explicit NotANumber(Words&&... /*words*/) {}
};

// Assimp gathers digits in ways of its own; of all magnitudes that are written without an exponent
// it must give the same bits, for other programs that use it.
TEST(ExportObj, AssimpReadsTheSameBitsOfAllUsualMagnitudes) {
  std::mt19937 random(2);
  for (int i = 0; i < 30000; ++i) {
    const int exponent = static_cast<int>(random() % 72) - 23;  // 2^-23 > 1e-7, 2^49 < 1e15
    const float size = std::ldexp(1 + static_cast<float>(random() >> 9) * 0x1p-23f, exponent);
    const float x = random() % 2 == 0 ? size : -size;
    const std::string digits = f32_digits(x);
    float read = 0;
    const char* end = Assimp::fast_atoreal_move<float, NotANumber>(digits.c_str(), read);
    ASSERT_EQ(*end, '\0') << digits;
    ASSERT_EQ(std::bit_cast<std::uint32_t>(read), std::bit_cast<std::uint32_t>(x)) << digits;
  }
}

TEST(ExportObj, ReadsBackBitForBitWhateverTheMagnitude) {
  const test::TempFolder folder;
  std::mt19937 random(2);
  SourceMesh mesh = test::soup(3000, 1);
  for (float& x : mesh.positions.f32) {
    do {
      x = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    } while (!std::isfinite(x));
  }
  const test::CookedTree cooked = test::cook_tree(mesh, CodecId::kPlainF32);
  const auto path = export_one(folder, "out.obj", cooked.tree, triangles_only());
  EXPECT_EQ(faces_of(imported(path)), faces_of(mesh));
}

TEST(ExportGlb, OneTriangleByteByByte) {
  const test::TempFolder folder;
  const test::CookedTree cooked = test::cook_tree(one_triangle(), CodecId::kWide4);
  const auto path = export_one(folder, "out.glb", cooked.tree, triangles_only());
  const std::string bytes = test::read_text(path);
  // Three positions, three indices of 16 bits, two bytes of padding.
  std::string binary;
  for (const float x : {0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.1f, -0.0f, 2.0f, 0.5f}) {
    std::array<char, 4> raw;
    std::memcpy(raw.data(), &x, 4);
    binary.append(raw.data(), 4);
  }
  binary += std::string("\0\0\1\0\2\0\0\0", 8);
  ASSERT_GT(bytes.size(), 20 + 8 + binary.size());
  EXPECT_EQ(bytes.substr(bytes.size() - binary.size() - 8),
            std::string("\x2c\0\0\0BIN\0", 8) + binary);
  const std::size_t json_length = bytes.size() - 20 - 8 - binary.size();
  EXPECT_EQ(json_length % 4, 0u);
  std::string header("glTF\2\0\0\0", 8);
  for (const std::size_t length : {bytes.size(), json_length}) {
    for (int shift = 0; shift < 32; shift += 8) header += static_cast<char>(length >> shift & 255);
  }
  EXPECT_EQ(bytes.substr(0, 20), header + "JSON");
  const nlohmann::json json = test::glb_document(bytes);
  EXPECT_EQ(json["buffers"], nlohmann::json::parse(R"([{"byteLength":44}])"));
  EXPECT_EQ(json["bufferViews"], nlohmann::json::parse(R"([
      {"buffer":0,"byteOffset":0,"byteLength":36,"target":34962},
      {"buffer":0,"byteOffset":36,"byteLength":6,"target":34963}])"));
  EXPECT_EQ(json["accessors"][0]["max"][2], double{0.5f});
  EXPECT_EQ(json["nodes"][json["scenes"][0]["nodes"][0].get<std::size_t>()]["name"], "one");
  EXPECT_EQ(test::read_glb(bytes).size(), 1u);
}

TEST(ExportGlb, IndicesGrowWithTheVertices) {
  const test::TempFolder folder;
  for (const unsigned cells : {254u, 255u, 256u}) {  // 65025, 65536 and 66049 vertices
    const SourceMesh mesh = test::terrain(cells, 1);
    const test::CookedTree cooked = test::cook_tree(mesh, CodecId::kWide4);
    const auto path = export_one(folder, "out.glb", cooked.tree, triangles_only());
    const std::string bytes = test::read_text(path);
    EXPECT_EQ(test::glb_document(bytes)["accessors"][1]["componentType"],
              mesh.positions.size() <= 65535 ? 5123 : 5125);
    EXPECT_EQ(test::read_glb(bytes).at(0).elements.size(), mesh.faces.size());
    EXPECT_EQ(triangles_of(imported(path)), triangles_of(mesh));
  }
}

TEST(ExportGlb, WhatF32CannotHoldIsRefused) {
  const test::TempFolder folder;
  const SourceMesh huge = far_away(test::torus(8, 6), 1e300, {0, 0, 0});
  const test::CookedTree cooked = test::cook_tree(huge, CodecId::kPackedF64);
  EXPECT_EQ(export_trees(std::span(&cooked.tree, 1), folder.path() / "out.glb", {}).code(),
            Errc::kMeshUnsupported);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "out.glb"));
  const auto obj = export_one(folder, "out.obj", cooked.tree, triangles_only());
  EXPECT_EQ(faces_of(imported(obj, Precision::kF64)), faces_of(huge));
}

TEST(ExportGlb, LevelsHaveColoursOfTheirOwn) {
  const test::TempFolder folder;
  const test::CookedTree cooked = test::cook_tree(test::soup(400, 3), CodecId::kPlainF32);
  const auto path = export_one(folder, "out.glb", cooked.tree, everything());
  const nlohmann::json json = test::glb_document(test::read_text(path));
  std::map<std::string, std::string> named;
  for (const auto& material : json["materials"]) {
    const auto& colour = material["pbrMetallicRoughness"]["baseColorFactor"];
    ASSERT_EQ(colour.size(), 4u);
    for (const auto& part : colour) ASSERT_TRUE(part >= 0 && part <= 1);
    EXPECT_TRUE(named.emplace(colour.dump(), material["name"]).second) << colour.dump();
  }
  EXPECT_EQ(named.size(), json["meshes"].size());
}

TEST(ExportFile, SolidBoxesEncloseTheSameSpace) {
  const test::TempFolder folder;
  const test::CookedTree cooked = test::cook_tree(test::soup(100, 3), CodecId::kWide8);
  ExportOptions options = everything();
  options.triangles = false;
  options.solid_boxes = true;
  for (const char* name : {"out.obj", "out.glb"}) {
    SCOPED_TRACE(name);
    for (const ViewedPart& part :
         test::read_viewer_file(export_one(folder, name, cooked.tree, options))) {
      EXPECT_FALSE(part.has_lines);
      // The divergence theorem: sides that all face outward enclose the sum of the boxes' volumes.
      double boxes = 0;
      for (std::uint64_t i = 0; i < part.box_count(); ++i) boxes += part.box(i).volume();
      double enclosed = 0;
      for (const auto& side : part.elements) {
        for (std::size_t i = 1; i + 1 < side.size(); ++i) {
          enclosed +=
              part.vertices[side[0]].dot(part.vertices[side[i]].cross(part.vertices[side[i + 1]])) /
              6;
        }
      }
      EXPECT_NEAR(enclosed, boxes, 1e-9 * boxes);
      EXPECT_GT(boxes, 0);
    }
  }
}

TEST(ExportFile, AnEmptyTreeIsAnEmptyObject) {
  const test::TempFolder folder;
  SourceMesh nothing;
  nothing.name = "nothing";
  const test::CookedTree cooked = test::cook_tree(nothing, CodecId::kPlainF32);
  ASSERT_TRUE(cooked.tree.empty());
  const auto obj = export_one(folder, "out.obj", cooked.tree, {});
  EXPECT_EQ(test::read_text(obj), "# boxtree 0.1.0\no nothing\ng nothing_triangles\n");
  const std::string glb = test::read_text(export_one(folder, "out.glb", cooked.tree, everything()));
  EXPECT_TRUE(test::read_glb(glb).empty());
  EXPECT_EQ(test::glb_document(glb)["nodes"], nlohmann::json::parse(R"([{"name":"nothing"}])"));
}

TEST(ExportFile, SeveralTreesAreSeveralObjects) {
  const test::TempFolder folder;
  SourceMesh torus = test::torus(8, 6);
  torus.name = "a torus\nf 1 2 3\\";
  SourceMesh nameless = test::city(4, 1);
  nameless.name.clear();
  const SourceMesh far = far_away(test::soup(20, 1), 1, {1e7, 0, 0});
  std::vector<EncodedTree> encoded;
  const std::vector<const SourceMesh*> meshes = {&torus, &nameless, &far};
  for (const SourceMesh* mesh : meshes) {
    encoded.push_back(test::require(cook_as(*mesh, CodecId::kWide8)));
  }
  const std::vector<std::byte> bytes = serialize(encoded);
  const File file = test::require(File::open(Bytes(bytes)));
  std::vector<Tree> trees;
  for (std::uint32_t i = 0; i < 3; ++i) trees.push_back(test::require(Tree::bind(file, i)));
  const auto obj = folder.path() / "out.obj";
  const auto glb = folder.path() / "out.glb";
  ASSERT_TRUE(export_trees(trees, obj, triangles_only()).ok());
  ASSERT_TRUE(export_trees(trees, glb, triangles_only()).ok());
  std::vector<std::pair<std::string, std::string>> names;
  for (const ViewedPart& part : test::read_viewer_file(obj)) {
    names.emplace_back(part.object, part.name);
  }
  EXPECT_EQ(names, (std::vector<std::pair<std::string, std::string>>{
                       {"a torus_f 1 2 3_", "a_torus_f_1_2_3__triangles"},
                       {"tree 1", "tree_1_triangles"},
                       {"soup", "soup_triangles"}}));
  const std::vector<ViewedPart> parts = test::read_viewer_file(glb);
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[0].object, torus.name);
  EXPECT_EQ(parts[1].object, "tree 1");
  EXPECT_EQ(parts[2].object, "soup");
  // Each its own translation: only positions of f64 need one.
  EXPECT_TRUE(parts[0].translation.isZero(0) && parts[1].translation.isZero(0));
  EXPECT_NEAR(parts[2].translation[0], 1e7, 20);
  // A reader of the whole meets the faces of all, tree after tree.
  const SourceMesh whole = imported(obj, Precision::kF64);
  const std::vector<FaceBits> exact = faces_of(whole);
  const std::vector<FaceBits> rounded = faces_of(as_f32(whole));
  std::size_t first = 0;
  for (const SourceMesh* mesh : meshes) {
    for (std::size_t f = 0; f < mesh->faces.size(); ++f) {
      ASSERT_EQ((mesh == &far ? exact : rounded).at(first + f), faces_of(*mesh)[f]);
    }
    first += mesh->faces.size();
  }
  EXPECT_EQ(first, exact.size());
}

TEST(ExportFile, PiecesOfAPolygonComeTogether) {
  const test::TempFolder folder;
  const auto source = folder.write("source.obj",
                                   "v 0 0 0\nv 2 0 0\nv 3 1 0\nv 1 3 0\nv -1 1 0\nv 0 0 1\n"
                                   "f 1 2 6\nf 1 2 3 4 5\nf 2 3 6\n");
  const SourceMesh mesh = imported(source);
  ASSERT_EQ(mesh.faces.size(), 5u);
  const test::CookedTree cooked = test::cook_tree(mesh, CodecId::kPlainF32);
  const SourceMesh again = imported(export_one(folder, "out.obj", cooked.tree, triangles_only()));
  std::vector<FaceBits> faces = faces_of(again);
  std::vector<FaceBits> expected = faces_of(mesh);
  ASSERT_EQ(faces.size(), 5u);
  EXPECT_EQ(faces.front(), expected.front());
  EXPECT_EQ(faces.back(), expected.back());
  std::sort(faces.begin(), faces.end());
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(faces, expected);
}

TEST(ExportFile, RefusesWhatMakesNoSense) {
  const test::TempFolder folder;
  const test::CookedTree cooked = test::cook_tree(test::soup(400, 3), CodecId::kWide8);
  const std::span<const Tree> trees(&cooked.tree, 1);
  const std::uint32_t depth = BoundTree::of(cooked.tree).depth();
  const auto code = [&](const char* name, std::vector<LevelRange> levels) {
    ExportOptions options;
    options.levels = std::move(levels);
    return export_trees(trees, folder.path() / name, options).code();
  };
  EXPECT_EQ(code("out.stl", {}), Errc::kInvalidQuery);
  EXPECT_EQ(code("obj", {}), Errc::kInvalidQuery);
  EXPECT_EQ(code("out.obj", {{0, 1}, {depth + 1, depth + 2}}), Errc::kInvalidQuery);
  EXPECT_EQ(code("out.obj", {{1, 0}}), Errc::kInvalidQuery);
  EXPECT_EQ(code("no/such/folder.obj", {}), Errc::kWriteFailed);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  EXPECT_EQ(code("out.OBJ", {{depth, 0xffffffffu}}), Errc::kOk);
}

// Any byte of the file may be wrong: an answer or an error, and on an error no file.
TEST(ExportFile, DamagedBytesAreShownOrRefused) {
  const test::TempFolder folder;
  std::map<Errc, int> met;
  for (const CodecId codec : {CodecId::kPlainF32, CodecId::kDedup, CodecId::kWide4}) {
    for (const bool grid : {false, true}) {
      const std::vector<std::byte> good =
          test::cook_bytes(test::city(6, 1), codec, grid ? on_grid(16) : CookOptions());
      // Each byte turned over, then each four bytes set: a NaN where they are a position.
      for (std::size_t i = 2 * sizeof(FileHeader); i < 2 * good.size() - 6; ++i) {
        std::vector<std::byte> bytes = good;
        if (i % 2 == 0) bytes[i / 2] ^= std::byte{0xff};
        if (i % 2 == 1) std::fill_n(bytes.data() + i / 2, 4, std::byte{0xff});
        test::repair_checksums(bytes);
        const Result<File> file = File::open(Bytes(bytes));
        if (!file) continue;
        const Result<Tree> tree = Tree::bind(*file);
        if (!tree) continue;
        const Result<DecodedFaces> faces = DecodedFaces::decode(*tree, ExportOrder::kSource);
        ++met[faces.code()];
        if (faces) {
          for (std::uint32_t f = 0; f < faces->face_count(); ++f) {
            const auto corner = faces->face(f);
            for (std::size_t c = 0; c < (corner[3] == kMissingCorner ? 3 : 4); ++c) {
              ASSERT_TRUE(faces->position(corner[c]).allFinite());
            }
          }
        }
        ++met[find_groups(*tree, {{0, kMaxDepth}}, true).code()];
      }
    }
  }
  for (const Errc code :
       {Errc::kOk, Errc::kNodeCorrupt, Errc::kVertexOutOfRange, Errc::kVertexNotFinite}) {
    EXPECT_GT(met[code], 0) << error_info(code).name;
  }
  for (const auto& [code, times] : met) EXPECT_NE(code, Errc::kInternal);

  std::vector<std::byte> bytes = test::cook_bytes(test::soup(100, 3), CodecId::kPlainF32);
  const File file = test::require(File::open(Bytes(bytes)));
  const Bytes nodes = OpenFile::of(file).section(SectionKind::kNodes, 0);
  std::fill_n(bytes.data() + (nodes.data() - bytes.data()), nodes.size(), std::byte{0xff});
  const Tree tree = test::require(Tree::bind(file));
  const auto old = folder.write("out.obj", "old");
  EXPECT_EQ(export_trees(std::span(&tree, 1), old, {}).code(), Errc::kNodeCorrupt);
  EXPECT_EQ(test::read_text(old), "old");
}

}  // namespace
}  // namespace boxtree::cooker
