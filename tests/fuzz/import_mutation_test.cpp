// SPDX-License-Identifier: MIT
// Hostile binary PLY and STL: every truncation is refused, every flipped bit and many random
// changes end in an error that names the file or in a mesh that keeps what import promises.
#include <cmath>
#include <cstring>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "cooker/import/import.h"
#include "tests/support/temp_folder.h"

namespace boxtree::cooker {
namespace {

template <class T>
void append(std::string& out, T value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

// A pyramid: four triangles, a quad and a pentagon that needs splitting.
std::string small_ply() {
  std::string ply =
      "ply\nformat binary_little_endian 1.0\nelement vertex 6\nproperty float x\n"
      "property float y\nproperty double z\nelement face 6\nproperty uchar flags\n"
      "property list uchar int vertex_indices\nelement edge 2\nproperty list uchar short ends\n"
      "end_header\n";
  const float corners[6][2] = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 1}, {1, 3}};
  for (const auto& [x, y] : corners) {
    append(ply, x);
    append(ply, y);
    append(ply, double{x == 1 ? 1.5 : 0.0});
  }
  const std::vector<std::vector<std::int32_t>> faces = {{0, 1, 4}, {1, 2, 4},    {2, 3, 4},
                                                        {3, 0, 4}, {3, 2, 1, 0}, {0, 1, 2, 5, 3}};
  for (const auto& face : faces) {
    ply += '\7';
    ply += static_cast<char>(face.size());
    for (const std::int32_t corner : face) append(ply, corner);
  }
  for (std::int16_t i = 0; i < 2; ++i) {
    ply += '\1';
    append(ply, i);
  }
  return ply;
}

std::string small_stl() {
  std::string stl(80, 'x');
  append(stl, std::uint32_t{4});
  for (int triangle = 0; triangle < 4; ++triangle) {
    for (int i = 0; i < 12; ++i) append(stl, static_cast<float>((i * 7 + triangle) % 5));
    append(stl, std::uint16_t{0});
  }
  return stl;
}

class ImportMutation : public testing::TestWithParam<const char*> {
 protected:
  [[nodiscard]] std::string whole() const {
    return std::strcmp(GetParam(), "ply") == 0 ? small_ply() : small_stl();
  }
  // From where on the file is ours alone: headers may turn it into one for assimp.
  [[nodiscard]] std::size_t body() const {
    const std::size_t end = whole().find("end_header\n");
    return end == std::string::npos ? 84 : end + 11;
  }
  // Whatever comes back, it must come back; true if that is a mesh.
  bool exercise(const std::string& bytes, const ImportOptions& options) const {
    const auto path = folder_.write(std::string("a.") + GetParam(), bytes);
    const Result<Imported> result = import_mesh(path, options);
    if (!result.ok()) {
      EXPECT_NE(result.error().detail.find(path.string()), std::string::npos);
      return false;
    }
    const SourceMesh& mesh = result->mesh;
    EXPECT_FALSE(mesh.faces.empty());
    for (const Face& face : mesh.faces) {
      for (std::size_t i = 0; i < (face.is_quad() ? 4u : 3u); ++i) {
        EXPECT_LT(face.corner[i], mesh.positions.size());
      }
    }
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      EXPECT_TRUE(mesh.positions[i].allFinite());
    }
    return true;
  }

  test::TempFolder folder_;
};

TEST_P(ImportMutation, EveryTruncationIsRefused) {
  const std::string file = whole();
  ASSERT_TRUE(exercise(file, {}));
  for (std::size_t size = 0; size < file.size(); ++size) {
    ASSERT_FALSE(exercise(file.substr(0, size), {})) << size;
  }
}

TEST_P(ImportMutation, EveryFlippedBitOfTheBody) {
  std::string file = whole();
  for (std::size_t bit = 8 * body(); bit < 8 * file.size(); ++bit) {
    const auto flip = static_cast<char>(1u << (bit % 8));
    file[bit / 8] = static_cast<char>(file[bit / 8] ^ flip);
    exercise(file, {.skip_bad = bit % 3 == 0,
                    .precision = bit % 2 == 0 ? Precision::kF32 : Precision::kF64});
    file[bit / 8] = static_cast<char>(file[bit / 8] ^ flip);
  }
}

TEST_P(ImportMutation, RandomBytesInTheBody) {
  std::mt19937 random(7);
  const std::string file = whole();
  std::size_t meshes = 0;
  for (int round = 0; round < 1000; ++round) {
    std::string changed = file;
    for (unsigned i = 0; i < 1 + random() % 4; ++i) {
      const std::size_t at = body() + random() % (file.size() - body());
      const unsigned char bytes[] = {0, 0xff, 0x7f, 0x80, static_cast<unsigned char>(random())};
      changed[at] = static_cast<char>(bytes[random() % 5]);
    }
    meshes += exercise(changed, {.skip_bad = round % 2 == 0}) ? 1u : 0u;
  }
  EXPECT_GT(meshes, 100u);
}

// Counts, in header and body, that nothing backs: refused before room is made for them.
TEST_P(ImportMutation, HugeCounts) {
  const std::string file = whole();
  for (const char* count : {"4294967295", "2147483648", "18446744073709551615"}) {
    for (const std::string element : {"vertex 6", "face 6", "edge 2"}) {
      std::string changed = file;
      const std::size_t at = changed.find(element);
      if (at == std::string::npos) continue;
      changed.replace(at + element.size() - 1, 1, count);
      EXPECT_FALSE(exercise(changed, {})) << element << ' ' << count;
    }
  }
  for (std::size_t at = body() - 4; at + 4 <= file.size(); ++at) {
    std::string changed = file;
    std::memset(changed.data() + at, 0xff, 4);
    exercise(changed, {.skip_bad = true});
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, ImportMutation, testing::Values("ply", "stl"),
                         [](const auto& kind) { return std::string(kind.param); });

}  // namespace
}  // namespace boxtree::cooker
