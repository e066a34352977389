// SPDX-License-Identifier: MIT
// Merged tiles answer with the numbers of the world, whatever the order of the tiles; what is no
// tile is refused. tests/farm/world.sh compares worlds with one tree of them.
#include "cooker/tile/merge_world.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "cooker/cli/job_words.h"
#include "cooker/proof/proof.h"
#include "cooker/shell/cook_job.h"
#include "tests/support/require.h"
#include "tests/support/temp_folder.h"

namespace boxtree::cooker {
namespace {

using test::require;
namespace fs = std::filesystem;
using Words = std::vector<std::string>;

Result<File> open_file_at(const fs::path& path) {
  return File::open(path);
}

class MergeWorld : public ::testing::Test {
 protected:
  // Cooks triangles of a square, of which the number in the world is given.
  fs::path cook(const std::string& name, const std::string& corners, const std::string& id,
                const Words& options = {"--exact", "--face-ids", "face"}) const {
    folder_.write(name + ".ply",
                  "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                  "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                  "property int face\nend_header\n0 0 0\n2 0 0\n2 2 0\n0 2 0\n3 " +
                      corners + " " + id + "\n");
    CookJob job = require(job_of_words(options));
    job.inputs = {folder_.path() / (name + ".ply")};
    job.output = folder_.path() / (name + ".bxt");
    static_cast<void>(require(cook_job(job)));
    return job.output;
  }
  Result<MergeReport> merge(const std::vector<fs::path>& files) const {
    return merge_world(folder_.path() / "world.bxt", files, open_file_at);
  }
  File world() const { return require(File::open(folder_.path() / "world.bxt")); }

  test::TempFolder folder_;
};

TEST_F(MergeWorld, SettlesTiesByTheNumbersOfFaces) {
  const fs::path low = cook("low", "0 1 2", "5"), high = cook("high", "0 2 3", "9");
  for (const std::vector<fs::path>& files : {std::vector{low, high}, std::vector{high, low}}) {
    const MergeReport report = require(merge(files));
    EXPECT_EQ(report.trees, 2u);
    EXPECT_EQ(report.faces, 2u);
    EXPECT_EQ(report.bytes, fs::file_size(folder_.path() / "world.bxt"));
    const File file = world();
    EXPECT_TRUE(verify_file(file).empty());
    const Scene scene = require(Scene::bind(file, {.require_face_ids = true}));
    // On the edge that both share.
    const Ray ray{{1, 1, 3}, {0, 0, -1}};
    EXPECT_EQ(require(closest_hit(scene, ray))->face.id, 5u);
    SceneRayHit hits[3];
    ASSERT_EQ(require(nearest_hits(scene, ray, hits)), 2u);
    EXPECT_EQ(hits[0].face.id, 5u);
    EXPECT_EQ(hits[1].face.id, 9u);
    EXPECT_EQ(require(closest_point(scene, {1, 1, 0.5}))->face.id, 5u);
    EXPECT_EQ(require(cast_closest(scene, Sphere{{1, 1, 3}, 0.5}, {{0, 0, -1}}))->face.id, 5u);
    // And beside it.
    EXPECT_EQ(require(closest_hit(scene, {{0.5, 1, 3}, {0, 0, -1}}))->face.id, 9u);
    EXPECT_EQ(require(closest_hit(scene, {{0.5, 1, 3}, {0, 0, -1}}))->normal,
              Eigen::Vector3d(0, 0, 1));
  }
}

TEST_F(MergeWorld, OfOneTileIsAScene) {
  static_cast<void>(require(merge({cook("one", "0 1 2", "7")})));
  const File file = world();
  EXPECT_TRUE(verify_file(file).empty());
  const Scene scene = require(Scene::bind(file));
  EXPECT_EQ(require(closest_hit(scene, {{1.5, 0.5, 3}, {0, 0, -1}}))->face.id, 7u);
  EXPECT_EQ(scene.trees()[0].name(), "one");
}

TEST_F(MergeWorld, RefusesWhatIsNoTile) {
  const fs::path tile = cook("tile", "0 1 2", "7");
  const auto refused = [&](const fs::path& other, const std::string& why) {
    const Result<MergeReport> report = merge({tile, other});
    ASSERT_FALSE(report.ok()) << why;
    EXPECT_EQ(report.code(), Errc::kMeshUnsupported) << report.error().detail;
    EXPECT_NE(report.error().detail.find(other.string()), std::string::npos);
    EXPECT_NE(report.error().detail.find(why), std::string::npos) << report.error().detail;
    EXPECT_FALSE(fs::exists(folder_.path() / "world.bxt"));
  };
  refused(cook("nameless", "0 1 2", "0", {"--exact", "--no-face-ids", "--codec", "wide8"}),
          "face ids");
  refused(cook("coarse", "0 1 2", "3", {"--grid-step", "2^-3", "--face-ids", "face"}), "grid");
  refused(cook("scene", "0 1 2", "3", {"--scene"}), "scene");
  EXPECT_EQ(merge({tile, folder_.path() / "absent.bxt"}).code(), Errc::kFileNotFound);
}

TEST_F(MergeWorld, RefusesAFaceThatTwoTilesHave) {
  const fs::path tile = cook("tile", "0 1 2", "70000"), other = cook("other", "0 2 3", "70000");
  const fs::path third = cook("third", "0 2 3", "4464");  // 70000 - 65536
  EXPECT_TRUE(merge({tile, third}).ok());
  for (const std::vector<fs::path>& files :
       {std::vector{tile, third, tile}, std::vector{tile, other}}) {
    const Result<MergeReport> report = merge(files);
    EXPECT_EQ(report.code(), Errc::kMeshUnsupported);
    EXPECT_EQ(report.error().detail,
              files.back().string() +
                  ": expected a tile as tile and cook make it: there is another face 70000 "
                  "before this one; name each tile of one world once");
  }
}

// All parts have the number of their polygon, and are in one tile.
TEST_F(MergeWorld, TakesAPolygonInParts) {
  folder_.write("parts.ply",
                "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
                "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                "property int face\nend_header\n0 0 0\n1 0 0\n2 1 0.5\n1 2 0\n0 1 0.3\n"
                "5 0 1 2 3 4 8\n");
  CookJob job = require(job_of_words({"--exact", "--face-ids", "face"}));
  job.inputs = {folder_.path() / "parts.ply"};
  job.output = folder_.path() / "parts.bxt";
  static_cast<void>(require(cook_job(job)));
  const MergeReport report = require(merge({job.output, cook("other", "0 2 3", "9")}));
  EXPECT_EQ(report.trees, 2u);
  EXPECT_EQ(report.faces, 4u);  // three parts and a triangle
  EXPECT_EQ(merge({job.output, cook("same", "0 2 3", "8")}).code(), Errc::kMeshUnsupported);
}

TEST_F(MergeWorld, RefusesTilesOfTwoGrids) {
  const fs::path coarse =
      cook("coarse", "0 1 2", "3", {"--grid-step", "2^-3", "--face-ids", "face"});
  const fs::path same = cook("same", "0 2 3", "4", {"--grid-step", "2^-3", "--face-ids", "face"});
  const fs::path fine = cook("fine", "0 2 3", "5", {"--grid-step", "2^-9", "--face-ids", "face"});
  EXPECT_TRUE(merge({coarse, same}).ok());
  EXPECT_EQ(merge({coarse, fine}).code(), Errc::kMeshUnsupported);
}

TEST_F(MergeWorld, FindsDamage) {
  const fs::path tile = cook("tile", "0 1 2", "7"), other = cook("other", "0 2 3", "8");
  std::string bytes = test::read_text(other);
  // In the section of a tree, whose checksum the table has: near the end of the file.
  const std::size_t at = bytes.size() - 24;
  bytes[at] = static_cast<char>(bytes[at] ^ 1);
  folder_.write("other.bxt", bytes);
  EXPECT_EQ(merge({tile, other}).code(), Errc::kChecksumMismatch);
  EXPECT_FALSE(fs::exists(folder_.path() / "world.bxt"));
}

}  // namespace
}  // namespace boxtree::cooker
