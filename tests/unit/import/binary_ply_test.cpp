// SPDX-License-Identifier: MIT
// Our reader of binary PLY against assimp's on the same bytes, and against the same mesh as text.
#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <functional>
#include <limits>
#include <random>

#include <assimp/Importer.hpp>
#include <assimp/scene.h>

#include "temp_files.h"

namespace boxtree::cooker {
namespace {

using BinaryPlyTest = ImportTest;

// A mesh and how to write it down. Values pass through double: every type of PLY fits in.
struct PlyText {
  std::string format = "binary_little_endian";
  std::string coordinate = "float";
  std::string length = "uchar";
  std::string index = "int";
  bool extras = false;  // other elements and properties around what we want
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::vector<std::int64_t>> faces;

  [[nodiscard]] std::string write() const;

 private:
  void put(std::string& out, const std::string& type, double value) const;
};

template <class T>
void put_bytes(std::string& out, double value, bool swapped) {
  auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(static_cast<T>(value));
  if (swapped) std::reverse(bytes.begin(), bytes.end());
  out.append(bytes.data(), bytes.size());
}

void PlyText::put(std::string& out, const std::string& type, double value) const {
  if (format == "ascii") {
    std::array<char, 400> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    out.append(digits.data(), end);
    out += ' ';
    return;
  }
  const bool swapped = format == "binary_big_endian";
  if (type == "char") put_bytes<std::int8_t>(out, value, swapped);
  if (type == "uchar") put_bytes<std::uint8_t>(out, value, swapped);
  if (type == "short") put_bytes<std::int16_t>(out, value, swapped);
  if (type == "ushort") put_bytes<std::uint16_t>(out, value, swapped);
  if (type == "int") put_bytes<std::int32_t>(out, value, swapped);
  if (type == "uint") put_bytes<std::uint32_t>(out, value, swapped);
  if (type == "float") put_bytes<float>(out, value, swapped);
  if (type == "double") put_bytes<double>(out, value, swapped);
}

std::string PlyText::write() const {
  std::string out = "ply\nformat " + format + " 1.0\ncomment by hand\n";
  if (extras) out += "element material 2\nproperty uchar red\nproperty double shine\n";
  out += "element vertex " + std::to_string(vertices.size()) + "\n";
  if (extras) out += "property float nx\n";
  for (const char* axis : {"x", "y", "z"}) out += "property " + coordinate + " " + axis + "\n";
  if (extras) out += "property uchar alpha\n";
  out += "element face " + std::to_string(faces.size()) + "\n";
  if (extras) out += "property float quality\nproperty list uchar short other\n";
  out += "property list " + length + " " + index + " vertex_indices\n";
  if (extras) out += "property uchar flags\nelement edge 1\nproperty list int double ends\n";
  out += "end_header\n";
  const auto end_line = [&] { out += format == "ascii" ? "\n" : ""; };
  for (int i = 0; extras && i < 2; ++i) {
    put(out, "uchar", 7);
    put(out, "double", 0.5);
    end_line();
  }
  for (const auto& vertex : vertices) {
    if (extras) put(out, "float", 1);
    for (const double value : vertex) put(out, coordinate, value);
    if (extras) put(out, "uchar", 255);
    end_line();
  }
  std::size_t number = 0;
  for (const auto& face : faces) {
    if (extras) {
      put(out, "float", 0.25);
      put(out, "uchar", static_cast<double>(++number % 3));
      for (std::size_t i = 0; i < number % 3; ++i) put(out, "short", -1);
    }
    put(out, length, static_cast<double>(face.size()));
    for (const std::int64_t corner : face) put(out, index, static_cast<double>(corner));
    if (extras) put(out, "uchar", 1);
    end_line();
  }
  if (extras) {
    put(out, "int", 2);
    put(out, "double", 0);
    put(out, "double", 1);
    end_line();
  }
  return out;
}

// Coordinates that text holds without rounding, many of them equal; faces of all sizes, among them
// planar quads.
PlyText random_mesh(unsigned seed, bool faulty) {
  std::mt19937 random(seed);
  const auto below = [&random](unsigned count) { return static_cast<int>(random() % count); };
  PlyText ply;
  for (int i = 0; i < 60; ++i) {
    ply.vertices.push_back({below(9) * 0.125 + 0.5, below(5) - 2.0, below(3) * 1.0});
  }
  if (faulty) ply.vertices[7][1] = std::numeric_limits<double>::quiet_NaN();
  if (faulty) ply.vertices[9][2] = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < 200; ++i) {
    std::vector<std::int64_t> face(
        static_cast<std::size_t>(below(10) < 8 ? 3 + below(3) : below(9)));
    for (std::int64_t& corner : face) corner = below(faulty ? 62 : 60);
    if (faulty && i % 50 == 49 && !face.empty()) face[0] = -1;
    ply.faces.push_back(face);
  }
  for (int i = 0; i < 20; ++i) {
    const double x = below(100) * 0.5, z = below(7) + 0.5;
    const auto first = static_cast<std::int64_t>(ply.vertices.size());
    ply.vertices.insert(ply.vertices.end(), {{x, 0, z}, {x + 3, 0, z}, {x + 3, 2, z}, {x, 2, z}});
    ply.faces.push_back({first, first + 1, first + 2, first + 3});
  }
  return ply;
}

void expect_same(const Imported& got, const Imported& expected) {
  const auto bits = [](const auto& values) {
    return std::string_view(reinterpret_cast<const char*>(values.data()),
                            values.size() * sizeof(values[0]));
  };
  EXPECT_EQ(bits(got.mesh.positions.f32), bits(expected.mesh.positions.f32));
  EXPECT_EQ(bits(got.mesh.positions.f64), bits(expected.mesh.positions.f64));
  EXPECT_EQ(bits(got.mesh.faces), bits(expected.mesh.faces));
  EXPECT_EQ(got.mesh.face_ids, expected.mesh.face_ids);
  const auto counts = [](const ImportReport& report) {
    return std::array{report.meshes,           report.meshes_unplaced, report.source_faces,
                      report.source_vertices,  report.points_skipped,  report.lines_skipped,
                      report.empty_skipped,    report.quads_kept,      report.quads_split,
                      report.ngons_split,      report.vertices_unused, report.vertices_welded,
                      report.degenerate_faces, report.skipped.size()};
  };
  EXPECT_EQ(counts(got.report), counts(expected.report));
  for (std::size_t i = 0; i < expected.report.skipped.size(); ++i) {
    EXPECT_EQ(got.report.skipped[i].face_id, expected.report.skipped[i].face_id);
    EXPECT_EQ(got.report.skipped[i].reason, expected.report.skipped[i].reason);
  }
}

// Assimp's polygons, those of three corners and more, in their order.
std::vector<std::vector<Eigen::Vector3d>> polygons_of_assimp(const std::filesystem::path& path) {
  std::vector<std::vector<Eigen::Vector3d>> polygons;
  Assimp::Importer importer;
  const aiScene* const scene = importer.ReadFile(path.string(), 0);
  if (scene == nullptr || scene->mNumMeshes != 1) return polygons;
  const aiMesh& mesh = *scene->mMeshes[0];
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    std::vector<Eigen::Vector3d> polygon;
    for (unsigned k = 0; k < mesh.mFaces[i].mNumIndices; ++k) {
      const aiVector3D& at = mesh.mVertices[mesh.mFaces[i].mIndices[k]];
      polygon.emplace_back(at.x, at.y, at.z);
    }
    if (polygon.size() >= 3) polygons.push_back(polygon);
  }
  return polygons;
}

// Triangles and quads corner by corner; what was split has corners of its polygon.
void expect_faces(const SourceMesh& mesh,
                  const std::vector<std::vector<Eigen::Vector3d>>& expected) {
  std::vector<std::size_t> pieces(expected.size());
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    ASSERT_LT(mesh.face_id(i), expected.size());
    const auto& polygon = expected[mesh.face_id(i)];
    const std::size_t corners = mesh.faces[i].is_quad() ? 4 : 3;
    const bool is_whole = corners == polygon.size();
    for (std::size_t k = 0; k < corners; ++k) {
      const Eigen::Vector3d corner = mesh.positions[mesh.faces[i].corner[k]];
      if (is_whole) {
        ASSERT_EQ(corner, polygon[k]) << "face " << i;
      } else {
        ASSERT_NE(std::find(polygon.begin(), polygon.end(), corner), polygon.end()) << i;
      }
    }
    pieces[mesh.face_id(i)] += is_whole ? polygon.size() - 2 : 1;
  }
  for (std::size_t id = 0; id < expected.size(); ++id) {
    EXPECT_EQ(pieces[id], expected[id].size() - 2) << "face id " << id;
  }
}

TEST_F(BinaryPlyTest, ReadsWhatAssimpReads) {
  for (unsigned seed = 0; seed < 24; ++seed) {
    SCOPED_TRACE(seed);
    PlyText ply = random_mesh(seed, false);
    ply.extras = seed % 3 == 1;
    ply.format = seed % 4 < 2 ? "binary_little_endian" : "binary_big_endian";
    ply.coordinate = seed % 5 == 4 ? "double" : "float";
    ply.length = std::array{"uchar", "char", "short", "ushort", "int", "uint"}[seed % 6];
    ply.index = std::array{"int", "uint", "short", "ushort"}[seed / 6];
    const std::string file = ply.write();
    const Imported got = load("a.ply", file);
    expect_invariants(got);
    expect_faces(got.mesh, polygons_of_assimp(write("a.ply", file)));
    ply.format = "ascii";
    expect_same(got, load("text.ply", ply.write()));
  }
}

TEST_F(BinaryPlyTest, LeavesOutBadFaces) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    PlyText ply = random_mesh(seed, true);
    ply.extras = seed % 3 == 1;
    std::vector<std::uint32_t> bad;
    std::uint32_t id = 0;
    for (const auto& face : ply.faces) {
      if (face.size() < 3) continue;
      const bool is_bad = std::any_of(face.begin(), face.end(), [&](std::int64_t vertex) {
        return vertex == 7 || vertex == 9 || vertex < 0 || vertex >= std::ssize(ply.vertices);
      });
      if (is_bad) bad.push_back(id);
      ++id;
    }
    const Imported got = load("a.ply", ply.write(), {.skip_bad = true});
    expect_invariants(got);
    std::vector<std::uint32_t> skipped;
    for (const SkippedFace& face : got.report.skipped) skipped.push_back(face.face_id);
    EXPECT_EQ(skipped, bad);
    EXPECT_EQ(got.report.source_faces, id);
  }
}

TEST_F(BinaryPlyTest, AllTypesOfCoordinates) {
  for (const char* type : {"char", "uchar", "short", "ushort", "int", "uint", "float", "double"}) {
    SCOPED_TRACE(type);
    PlyText ply;
    ply.vertices = {{0, 0, 0}, {100, 0, 0}, {0, 50, 1}};
    ply.faces = {{0, 1, 2}};
    ply.coordinate = type;
    const Imported got = load("a.ply", ply.write());
    EXPECT_EQ(got.mesh.positions[1], Eigen::Vector3d(100, 0, 0));
    EXPECT_EQ(got.mesh.positions[2], Eigen::Vector3d(0, 50, 1));
  }
}

TEST_F(BinaryPlyTest, AllDigitsInF64AsFromText) {
  const ImportOptions options{.precision = Precision::kF64};
  for (unsigned seed = 100; seed < 106; ++seed) {
    PlyText ply = random_mesh(seed, false);
    ply.coordinate = "double";
    for (auto& vertex : ply.vertices) vertex[0] = vertex[0] * 1e6 + 0.1;
    const Imported got = load("ours.ply", ply.write(), options);
    expect_invariants(got);
    ply.format = "ascii";
    expect_same(got, load("text.ply", ply.write(), options));
  }
}

// Assimp takes it for the second half of a line end after the header, and drops it.
TEST_F(BinaryPlyTest, BodyThatBeginsWithALineEnd) {
  PlyText ply;
  ply.vertices = {{std::bit_cast<float>(0x3f80000au), 0, 0}, {1, 0, 2}, {0, 1, 0}};
  ply.faces = {{0, 1, 2}};
  const std::string file = ply.write();
  EXPECT_EQ(load("a.ply", file).mesh.positions[0][0], ply.vertices[0][0]);
  // With the line ends of other systems.
  std::string other;
  const std::size_t body = file.find("end_header\n") + 11;
  for (const char c : file.substr(0, body))
    other += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(load("b.ply", other + file.substr(body)).mesh.positions[0][0], ply.vertices[0][0]);
}

TEST_F(BinaryPlyTest, ManyCornersAndLongBodies) {
  PlyText ply;
  ply.length = "int";
  std::vector<std::int64_t> all;
  for (int i = 0; i < 30'000; ++i) {  // more than a buffer of vertices, on a convex arc
    ply.vertices.push_back({i * 1.0, i * (30'000.0 - i) / 1024, 0});
    all.push_back(29'999 - i);
  }
  ply.faces = {all, {0, 1, 2}, all};
  const Imported got = load("a.ply", ply.write());
  expect_invariants(got);
  EXPECT_EQ(got.mesh.faces.size(), 2u * 29'998 + 1);
  EXPECT_EQ(got.mesh.face_id(29'998), 1u);
}

TEST_F(BinaryPlyTest, FaultsAreNamed) {
  PlyText ply;
  ply.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {std::nan(""), 0, 0}};
  ply.faces = {{0}, {0, 1, 2}, {0, 1, 3}};
  EXPECT_TRUE(
      has(fail("a.ply", ply.write()).detail, "face 1: vertex 3 is not finite: (nan, 0, 0)"));
  ply.faces[2] = {0, 1, 2, 4};
  const Error range = fail("a.ply", ply.write());
  EXPECT_EQ(range.code, Errc::kMeshIndexOutOfRange);
  EXPECT_TRUE(has(range.detail, "face 1: corner 3 names vertex 4, but there are 4 vertices"));
  ply.faces = {{0}, {0, 1}, {}};
  const Error none = fail("a.ply", ply.write());
  EXPECT_EQ(none.code, Errc::kNoFaces);
  EXPECT_TRUE(has(none.detail, "1 point, 1 line, 1 face without corners"));
}

// Stated counts and lengths are held against the bytes that are there, before any room is made.
TEST_F(BinaryPlyTest, CountsThatCannotBe) {
  PlyText ply;
  ply.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  ply.faces = {{0, 1, 2}, {2, 1, 0}};
  ply.length = "int";
  const auto with = [&](std::string_view from, std::string_view to) {
    std::string file = ply.write();
    file.replace(file.find(from), from.size(), to);
    return fail("a.ply", file);
  };
  EXPECT_TRUE(has(with("vertex 3", "vertex 30").detail, "30 elements 'vertex' cannot be in"));
  EXPECT_TRUE(has(with("vertex 3", "vertex 30").detail, "at most, as if the file was cut short"));
  for (const char* count : {"4294967295", "18446744073709551615", "99999999999999999999999"}) {
    EXPECT_EQ(with("vertex 3", "vertex " + std::string(count)).code, Errc::kImportFailed);
    EXPECT_EQ(with("face 2", "face " + std::string(count)).code, Errc::kImportFailed);
  }
  std::string file = ply.write();
  for (const std::int32_t length : {-1, 4, std::numeric_limits<std::int32_t>::max()}) {
    std::memcpy(file.data() + file.size() - 16, &length, sizeof(length));
    const Error error = fail("a.ply", file);
    EXPECT_EQ(error.code, Errc::kImportFailed);
    EXPECT_TRUE(
        has(error.detail, "face 1 of 2: a list of " + std::to_string(length) + " cannot be in"));
  }
}

// Two strips of one list, the second of them open: as Stanford's files have them.
TEST_F(BinaryPlyTest, Strips) {
  const std::vector<std::int32_t> strips = {0, 1, 2, 3, 4, -1, -1, 4, 3, 1, -1, 2, 0};
  std::string ply =
      "ply\nformat binary_little_endian 1.0\nelement vertex 5\nproperty float x\n"
      "property float y\nproperty float z\nelement tristrips 1\n"
      "property list int int vertex_indices\nend_header\n";
  std::string text = ply;
  text.replace(text.find("binary_little_endian"), 20, "ascii");
  const auto put = [&](auto value) {
    ply.append(reinterpret_cast<const char*>(&value), sizeof(value));
    text += std::to_string(value) + " ";
  };
  for (const std::array<float, 3>& v : std::initializer_list<std::array<float, 3>>{
           {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 1}}) {
    for (const float x : v) put(x);
    text += '\n';
  }
  put(static_cast<std::int32_t>(strips.size()));
  for (const std::int32_t vertex : strips) put(vertex);
  text += '\n';
  const Imported got = load("a.ply", ply);
  expect_invariants(got);
  expect_same(got, load("text.ply", text));
  const std::vector<std::array<std::uint32_t, 3>> expected = {
      {0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {4, 3, 1}};
  ASSERT_EQ(got.mesh.faces.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(got.mesh.faces[i].corner[k], expected[i][k]);
  }
  EXPECT_EQ(got.report.lines_skipped, 1u);
  const std::size_t last = text.rfind("2 0 ");
  const Error error = fail("b.ply", text.replace(last, 3, "2 9 0"));
  EXPECT_TRUE(has(error.detail, "'tristrips' 0 has 15 words; its properties take 14"));
  std::string wrong = ply;
  wrong[wrong.size() - 4 * 4] = 77;
  EXPECT_EQ(fail("c.ply", wrong).code, Errc::kMeshIndexOutOfRange);
}

}  // namespace
}  // namespace boxtree::cooker
