// SPDX-License-Identifier: MIT
// Whatever it is called: what is read is not written over.
#include "cooker/write/outputs.h"

#include <array>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "cooker/cook.h"
#include "tests/support/temp_folder.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTriangle = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";

TEST(Outputs, AreFilesOfTheirOwn) {
  const test::TempFolder folder;
  const fs::path mesh = folder.write("m.obj", kTriangle);
  fs::create_hard_link(mesh, folder.path() / "hard");
  fs::create_symlink(mesh, folder.path() / "soft");
  fs::create_directory(folder.path() / "sub");
  fs::create_symlink("new", folder.path() / "dangling");
  const auto code = [&](const fs::path& output, const fs::path& other) {
    return check_outputs(std::array{folder.path() / output, other}, std::array{mesh}).code();
  };
  for (const char* same : {"m.obj", "./m.obj", "sub/../m.obj", "hard", "soft"}) {
    EXPECT_EQ(code(same, ""), Errc::kWriteFailed) << same;
  }
  EXPECT_EQ(code("out", ""), Errc::kOk);
  EXPECT_EQ(code("out", folder.path() / "out"), Errc::kWriteFailed);
  EXPECT_EQ(code("new", folder.path() / "dangling"), Errc::kWriteFailed);
  EXPECT_EQ(code("out", folder.path() / "new"), Errc::kOk);
}

TEST(Outputs, ACookDoesNotWriteOverWhatItRead) {
  const test::TempFolder folder;
  const fs::path mesh = folder.write("m.obj", kTriangle);
  const fs::path material = folder.write("m.mtl", "newmtl a\n");
  for (const fs::path& output : {mesh, material}) {
    const std::string before = test::read_text(output);
    EXPECT_EQ(cook(std::vector{mesh}, output, CookOptions()).code(), Errc::kWriteFailed) << output;
    EXPECT_EQ(test::read_text(output), before);
  }
}

TEST(Outputs, WhatComesBeforeWritingCanEndACook) {
  const test::TempFolder folder;
  const fs::path mesh = folder.write("m.obj", kTriangle);
  const fs::path material = folder.write("m.mtl", "newmtl a\n");
  CookOptions options;
  std::vector<fs::path> told;
  options.before_writing = [&told](std::span<const fs::path> read) {
    told.assign(read.begin(), read.end());
    return Status(Error{Errc::kWriteFailed, "no"});
  };
  EXPECT_EQ(cook(std::vector{mesh}, folder.path() / "out", options).code(), Errc::kWriteFailed);
  EXPECT_EQ(told, (std::vector{mesh, material}));
  EXPECT_FALSE(fs::exists(folder.path() / "out"));
}

}  // namespace
}  // namespace boxtree::cooker
