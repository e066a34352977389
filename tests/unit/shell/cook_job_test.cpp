// SPDX-License-Identifier: MIT
// What a job reads, writes and refuses to write.
#include "cooker/shell/cook_job.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "runtime/tree/bound_tree.h"
#include "tests/support/require.h"
#include "tests/support/temp_folder.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;
using test::require;

constexpr const char* kTriangle = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
// Beside it, with corners that a grid has to move.
constexpr const char* kOther =
    "v 1 0.3333333 0\nv 2.7182818 0 0\nv 1.4142135 1 3.1415926\nv 0 1 1\nf 1 2 3\nf 1 3 4\n";

TEST(CookJob, NothingThatWasReadIsWrittenOver) {
  const test::TempFolder folder;
  const fs::path mesh = folder.write("m.obj", kTriangle);
  const fs::path material = folder.write("m.mtl", "newmtl a\n");
  const fs::path output = folder.path() / "out";
  for (const fs::path& same : {mesh, material}) {
    const std::string before = test::read_text(same);
    EXPECT_EQ(cook_job({{mesh}, same}).code(), Errc::kWriteFailed) << same;
    EXPECT_EQ(cook_job({.inputs = {mesh}, .output = output, .depfile = same}).code(),
              Errc::kWriteFailed)
        << same;
    EXPECT_EQ(test::read_text(same), before);
    EXPECT_FALSE(fs::exists(output));
  }
  EXPECT_EQ(cook_job({.inputs = {mesh}, .output = output, .depfile = output}).code(),
            Errc::kWriteFailed);
  EXPECT_EQ(cook_job({.inputs = {mesh}, .output = ""}).code(), Errc::kWriteFailed);
  EXPECT_FALSE(fs::exists(output));
}

TEST(CookJob, TheDepfileListsAllThatWasRead) {
  const test::TempFolder folder;
  const fs::path mesh = folder.write("a mesh.obj", kTriangle);
  const fs::path material = folder.write("m.mtl", "newmtl a\n");
  const fs::path profile =
      folder.write("scene.toml", "[scene]\nsource = \"a mesh.obj\"\nexact = true\n");
  const fs::path output = folder.path() / "out.bxt";
  const fs::path depfile = folder.path() / "out.d";
  const Summary summary =
      require(cook_job({.output = output, .profile = profile, .depfile = depfile}));
  EXPECT_EQ(summary.files_read, (std::vector{profile, mesh, material}));
  EXPECT_EQ(test::read_text(depfile),
            output.string() + ": \\\n  " + profile.string() + " \\\n  " + folder.path().string() +
                "/a\\ mesh.obj \\\n  " + material.string() + "\n" + profile.string() + ":\n" +
                folder.path().string() + "/a\\ mesh.obj:\n" + material.string() + ":\n");
  EXPECT_EQ(summary.file_bytes, fs::file_size(output));
}

// An error of the depfile, too, comes before anything of the output changes.
TEST(CookJob, WithoutItsDepfileThereIsNoOutput) {
  const test::TempFolder folder;
  const fs::path mesh = folder.write("m.obj", kOther);
  const fs::path output = folder.write("out.bxt", "before");
  EXPECT_EQ(
      cook_job({.inputs = {mesh}, .output = output, .depfile = folder.path() / "absent" / "out.d"})
          .code(),
      Errc::kWriteFailed);
  EXPECT_EQ(test::read_text(output), "before");
}

// Several inputs on one grid were once imported twice, the first time to be measured.
TEST(CookJob, EachInputIsReadOnceAndAllShareOneGrid) {
  const test::TempFolder folder;
  const std::vector<fs::path> inputs{folder.write("a.obj", kOther), folder.write("b.obj", kOther),
                                     folder.write("m.obj", kTriangle)};
  folder.write("m.mtl", "newmtl a\n");
  const fs::path output = folder.path() / "out.bxt";
  CookJob job{.inputs = inputs, .output = output};
  job.options.geometry = GeometryId::kGrid;
  job.options.grid.bits = 16;
  std::vector<std::string> steps;
  const Summary summary = require(cook_job(job, [&](const std::string& step) {
    steps.push_back(step);
    if (!step.starts_with("build ")) return;
    for (const fs::path& input : inputs) fs::remove(input);  // all are measured by now
  }));
  for (const fs::path& input : inputs) {
    EXPECT_EQ(std::count(steps.begin(), steps.end(), "import " + input.filename().string()), 1);
    EXPECT_FALSE(fs::exists(input));
  }
  const File file = require(File::open(output));
  ASSERT_EQ(file.tree_count(), 3u);
  const Tree first = require(Tree::bind(file, 0));
  for (std::uint32_t tree = 1; tree < 3; ++tree) {
    EXPECT_EQ(BoundTree::of(require(Tree::bind(file, tree))).grid_exponent(),
              BoundTree::of(first).grid_exponent());
  }
  ASSERT_EQ(summary.trees.size(), 3u);
  EXPECT_EQ(summary.trees[1].tree.name, "b");
  EXPECT_TRUE(summary.trees[1].tree.nodes.bytes.empty());
  EXPECT_EQ(summary.imports.size(), 3u);
  EXPECT_FALSE(summary.scene.has_value());
}

TEST(CookJob, InputsWithoutACommonGridAreReadOneAfterTheOther) {
  const test::TempFolder folder;
  const CookJob job{.inputs = {folder.write("a.obj", kOther), folder.write("b.obj", kOther)},
                    .output = folder.path() / "out.bxt"};
  std::vector<std::string> steps;
  ASSERT_TRUE(cook_job(job, [&](const std::string& step) { steps.push_back(step); }).ok());
  EXPECT_EQ(steps, (std::vector<std::string>{"import a.obj", "build a", "import b.obj", "build b",
                                             "write out.bxt"}));
}

TEST(CookJob, ABlobOfASceneIsAccountedForAsAWhole) {
  const test::TempFolder folder;
  const fs::path mesh = folder.write("m.obj", kOther);
  const fs::path output = folder.path() / "out.bxt";
  CookJob job{.inputs = {mesh}, .output = output, .as_scene = true};
  job.options.codec = CodecId::kPlainF32;
  job.options.blob = BlobMethod::kZstd;
  const Summary summary = require(cook_job(job));
  EXPECT_EQ(summary.file_bytes, fs::file_size(output));
  ASSERT_FALSE(summary.why.empty());
  EXPECT_EQ(summary.why.front().part, "blob");
  EXPECT_EQ(summary.why.front().bytes, summary.file_bytes);
}

}  // namespace
}  // namespace boxtree::cooker
