// SPDX-License-Identifier: MIT
// A tile is compared with its sources by its cook record: bytes and options, and nothing where
// either is not there.
#include "cooker/tile/stale_tile.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "cooker/choose/cost_file.h"
#include "cooker/cli/job_words.h"
#include "tests/support/require.h"
#include "tests/support/temp_folder.h"

namespace boxtree::cooker {
namespace {

using test::require;
namespace fs = std::filesystem;
using Words = std::vector<std::string>;
using Comparison = SourceComparison::Result;

class StaleTile : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& height) const {
    folder_.write(name,
                  "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                  "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                  "property int face\nend_header\n0 0 0\n2 0 0\n2 2 " +
                      height + "\n3 0 1 2 7\n");
  }
  CookJob job(const Words& inputs, const Words& options) const {
    CookJob job = require(job_of_words(options));
    for (const std::string& input : inputs) job.inputs.push_back(folder_.path() / input);
    if (!job.costs.empty()) job.costs = folder_.path() / job.costs;
    job.output = folder_.path() / "tile.bxt";
    return job;
  }
  static SourceComparison compare(const CookJob& job) {
    return require(compare_with_sources(job, require(File::open(job.output))));
  }

  test::TempFolder folder_;
};

const Words kOptions{"--exact", "--face-ids", "face"};

TEST_F(StaleTile, IsOneWhoseSourceWasEdited) {
  write("a.ply", "0");
  const CookJob tile = job({"a.ply"}, kOptions);
  static_cast<void>(require(cook_job(tile)));
  EXPECT_EQ(compare(tile).result, Comparison::kSame);
  write("a.ply", "1");
  EXPECT_EQ(compare(tile).result, Comparison::kDiffers);
  EXPECT_EQ(compare(tile).difference, "it was cooked from other bytes than " +
                                          (folder_.path() / "a.ply").string() + " has now");
  static_cast<void>(require(cook_job(tile)));
  EXPECT_EQ(compare(tile).result, Comparison::kSame);
}

TEST_F(StaleTile, IsOneOfOtherOptionsOrSources) {
  write("a.ply", "0");
  write("b.ply", "1");
  static_cast<void>(require(cook_job(job({"a.ply"}, kOptions))));
  const CookJob coarse = job({"a.ply"}, {"--grid-step", "2^-3", "--face-ids", "face"});
  EXPECT_EQ(compare(coarse).difference,
            "it was cooked with other options than the manifest has now");
  EXPECT_EQ(compare(job({"a.ply", "b.ply"}, kOptions)).difference,
            "it was cooked from other sources than the manifest has now");
  EXPECT_EQ(compare(job({"b.ply"}, kOptions)).result, Comparison::kDiffers);
}

// What a record says of the options is what the job would write now, whatever they are.
TEST_F(StaleTile, IsNoneWithAnyOptions) {
  write("a.ply", "0");
  write("b.ply", "1");
  folder_.write("c.obj", "mtllib c.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\ng a\nf 1 2 3\n");
  folder_.write("c.mtl", "newmtl stone\n");
  const auto costs = compiled_costs();
  folder_.write("costs.json", costs_to_json({{costs.begin(), costs.end()}, 1.5}));
  for (const Words& options : std::vector<Words>{{},
                                                 {"--tolerance", "0.001"},
                                                 {"--grid-bits", "12", "--for", "memory"},
                                                 {"--f64", "--skip-bad", "--active-edges", "5"},
                                                 {"--costs", "costs.json"},
                                                 {"--max-slowdown", "1.5"},
                                                 {"--user-data", "face"}}) {
    const CookJob tile = job({"a.ply", "b.ply"}, options);
    static_cast<void>(require(cook_job(tile)));
    EXPECT_EQ(compare(tile).difference, "") << ::testing::PrintToString(options);
    EXPECT_EQ(compare(tile).result, Comparison::kSame);
  }
  const CookJob referring = job({"c.obj"}, {"--materials", "--user-data", "groups"});
  static_cast<void>(require(cook_job(referring)));
  EXPECT_EQ(compare(referring).difference, "");
  folder_.write("c.mtl", "newmtl wood\n");
  EXPECT_EQ(compare(referring).result, Comparison::kDiffers);
}

TEST_F(StaleTile, IsUnknownWithoutASourceOrARecord) {
  write("a.ply", "0");
  CookJob tile = job({"a.ply"}, kOptions);
  static_cast<void>(require(cook_job(tile)));
  fs::remove(tile.inputs.front());
  EXPECT_EQ(compare(tile).result, Comparison::kUnknown);
  write("a.ply", "1");
  Words stripped = kOptions;
  stripped.emplace_back("--strip");
  tile = job({"a.ply"}, stripped);
  static_cast<void>(require(cook_job(tile)));
  EXPECT_EQ(compare(tile).result, Comparison::kUnknown);
}

}  // namespace
}  // namespace boxtree::cooker
