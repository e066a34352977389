// SPDX-License-Identifier: MIT
// Tiles of a world, imported again, against the import of the world: each face once, by its number
// and bit for bit.
#include "cooker/tile/tile_world.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cooker/farm/manifest.h"
#include "cooker/import/import.h"
#include "tests/support/require.h"
#include "tests/support/temp_folder.h"

namespace boxtree::cooker {
namespace {

using test::require;
namespace fs = std::filesystem;

// Hills of 2 edge^2 triangles in a text that lists them row by row.
std::string hills(int edge, float shift) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex " + std::to_string((edge + 1) * (edge + 1)) +
      "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
      std::to_string(2 * edge * edge) + "\nproperty list uchar int vertex_indices\nend_header\n";
  for (int i = 0; i <= edge; ++i) {
    for (int j = 0; j <= edge; ++j) {
      text += std::to_string(static_cast<float>(i) * 1.25f - 20 + shift) + " " +
              std::to_string(static_cast<float>(j) * 1.25f - 20) + " " +
              std::to_string(static_cast<float>((i * 7 + j * 13) % 17) * 0.3f) + "\n";
    }
  }
  for (int i = 0; i < edge; ++i) {
    for (int j = 0; j < edge; ++j) {
      const int a = i * (edge + 1) + j, b = a + edge + 1;
      text += "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(b + 1) +
              "\n3 " + std::to_string(a) + " " + std::to_string(b + 1) + " " +
              std::to_string(a + 1) + "\n";
    }
  }
  return text;
}

using Corners = std::array<std::array<float, 3>, 3>;

Corners corners_of(const SourceMesh& mesh, std::size_t face) {
  Corners corners;
  for (std::size_t c = 0; c < 3; ++c) {
    const float* const p = &mesh.positions.f32[std::size_t{3} * mesh.faces[face].corner[c]];
    corners[c] = {p[0], p[1], p[2]};
  }
  return corners;
}

class TileWorld : public ::testing::Test {
 protected:
  TileOptions options_for(const std::string& name) const {
    TileOptions options;
    options.sources = {folder_.path() / "a.ply", folder_.path() / "b.ply"};
    options.jobs = folder_.path() / (name + ".jsonl");
    options.folder = folder_.path() / name;
    options.triangles_per_tile = 100;
    options.cook_options = {"--exact"};
    return options;
  }

  // The text of each tile of the manifest, by its name.
  std::map<std::string, std::string> texts(const TileOptions& options) const {
    std::map<std::string, std::string> texts;
    for (const ManifestLine& line :
         require(parse_manifest(test::read_text(options.jobs), "jobs.jsonl"))) {
      texts[line.inputs.at(0).filename().string()] = test::read_text(line.inputs[0]);
      EXPECT_EQ(line.options, (std::vector<std::string>{"--exact", "--face-ids", "face"}));
    }
    return texts;
  }

  test::TempFolder folder_;
};

TEST_F(TileWorld, HasEachFaceOnceWithItsNumber) {
  folder_.write("a.ply", hills(30, 0));
  folder_.write("b.ply", hills(20, 0.5f));
  const TileOptions options = options_for("world");
  const TileReport report = require(tile_world(options));
  EXPECT_EQ(report.faces, 1800u + 800u);
  EXPECT_EQ(report.written, report.tiles);
  EXPECT_LE(report.largest, 100u);

  std::vector<Corners> expected;
  for (const fs::path& source : options.sources) {
    const Imported whole = require(import_mesh(source));
    for (std::size_t f = 0; f < whole.mesh.faces.size(); ++f) {
      expected.push_back(corners_of(whole.mesh, f));
    }
  }
  std::set<std::uint32_t> seen;
  std::size_t tiles = 0;
  for (const ManifestLine& line :
       require(parse_manifest(test::read_text(options.jobs), "jobs.jsonl"))) {
    ImportOptions import;
    import.face_ids = kTileFaceIds;
    const Imported tile = require(import_mesh(line.inputs.at(0), import));
    for (std::size_t f = 0; f < tile.mesh.faces.size(); ++f) {
      const std::uint32_t id = tile.mesh.face_id(f);
      ASSERT_LT(id, expected.size());
      EXPECT_TRUE(seen.insert(id).second) << id;
      EXPECT_EQ(corners_of(tile.mesh, f), expected[id]);
    }
    ++tiles;
  }
  EXPECT_EQ(seen.size(), expected.size());
  EXPECT_EQ(tiles, report.tiles);
}

TEST_F(TileWorld, DoesNotDependOnMemory) {
  folder_.write("a.ply", hills(40, 0));
  folder_.write("b.ply", hills(20, 0.5f));
  const TileOptions plenty = options_for("plenty");
  TileOptions little = options_for("little");
  little.memory = std::uint64_t{2} << 20;
  const TileReport report = require(tile_world(plenty));
  EXPECT_EQ(require(tile_world(little)).tiles, report.tiles);
  EXPECT_EQ(texts(little), texts(plenty));
}

TEST_F(TileWorld, RefusesTooLittleMemory) {
  folder_.write("a.ply", hills(40, 0));
  folder_.write("b.ply", hills(20, 0.5f));
  TileOptions options = options_for("world");
  options.memory = 1000;
  EXPECT_EQ(tile_world(options).code(), Errc::kMeshUnsupported);  // texts are imported
  options.memory = std::uint64_t{2} << 20;
  options.triangles_per_tile = 4;
  const auto refused = tile_world(options);
  EXPECT_EQ(refused.code(), Errc::kBudgetUnreachable);
  EXPECT_FALSE(fs::exists(options.jobs));
}

TEST_F(TileWorld, EditsChangeTheirTilesAlone) {
  folder_.write("a.ply", hills(40, 0));
  folder_.write("b.ply", hills(20, 0.5f));
  const TileOptions options = options_for("world");
  static_cast<void>(require(tile_world(options)));
  EXPECT_EQ(require(tile_world(options)).written, 0u);
  const std::map<std::string, std::string> before = texts(options);

  std::string text = hills(40, 0);
  const std::size_t at = text.find("end_header\n") + 11;
  text.replace(at, text.find(' ', at) - at, "-20.125");  // of the first vertex
  folder_.write("a.ply", text);
  const TileReport report = require(tile_world(options));
  EXPECT_EQ(report.written, 1u);
  const std::map<std::string, std::string> after = texts(options);
  std::size_t changed = 0;
  for (const auto& [name, bytes] : after) {
    ASSERT_TRUE(before.contains(name)) << name;
    if (before.at(name) != bytes) ++changed;
  }
  EXPECT_EQ(changed, 1u);
  EXPECT_EQ(after.size(), before.size());
}

TEST_F(TileWorld, WritesOverNothingElse) {
  folder_.write("a.ply", hills(40, 0));
  folder_.write("b.ply", hills(20, 0.5f));
  const TileOptions options = options_for("world");
  folder_.write("world.jsonl", "my notes\n");
  EXPECT_EQ(tile_world(options).code(), Errc::kWriteFailed);
  EXPECT_EQ(test::read_text(options.jobs), "my notes\n");
  // Found by a newcomer: a manifest that was written by hand.
  const std::string by_hand = R"({"inputs":["a.ply"],"output":"a.bxt","options":["--exact"]})";
  folder_.write("world.jsonl", by_hand);
  EXPECT_EQ(tile_world(options).code(), Errc::kWriteFailed);
  EXPECT_EQ(test::read_text(options.jobs), by_hand);
  fs::remove(options.jobs);
  static_cast<void>(require(tile_world(options)));
  const fs::path tile =
      require(parse_manifest(test::read_text(options.jobs), "jobs.jsonl")).at(0).inputs.at(0);
  folder_.write("world/" + tile.filename().string(), "my mesh\n");
  EXPECT_EQ(tile_world(options).code(), Errc::kWriteFailed);
  EXPECT_EQ(test::read_text(tile), "my mesh\n");
  // A source with the name of a tile.
  folder_.write("world/" + tile.filename().string(), hills(40, 0));
  TileOptions of_tile = options;
  of_tile.sources[0] = tile;
  EXPECT_EQ(tile_world(of_tile).code(), Errc::kWriteFailed);
  EXPECT_EQ(test::read_text(tile), hills(40, 0));
  TileOptions same = options;
  same.jobs = same.sources[0];
  EXPECT_EQ(tile_world(same).code(), Errc::kWriteFailed);
}

}  // namespace
}  // namespace boxtree::cooker
