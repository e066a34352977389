// SPDX-License-Identifier: MIT
// Whatever it is called: what is read is not written over.
#include "cooker/write/outputs.h"

#include <array>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/temp_folder.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

TEST(Outputs, AreFilesOfTheirOwn) {
  const test::TempFolder folder;
  const fs::path mesh = folder.write("m.obj", "v 0 0 0\n");
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

}  // namespace
}  // namespace boxtree::cooker
