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

// An export over the mesh of the cook, a cook over a profile.
TEST(Outputs, TakeThePlaceOfTheirKindAlone) {
  const test::TempFolder folder;
  const std::string cooked =
      "\x89"
      "BXT\r\n\x1a\n and more";
  const std::string obj = "# boxtree 0.1.0\no m\n";
  const std::string glb =
      std::string("glTF\2\0\0\0", 8) + R"(JSON{"asset":{"generator":"boxtree 0.1.0"}})";
  const std::string other = "v 0 0 0\n# boxtree 0.1.0\n";
  for (const auto& [kind, content] : {std::pair(OutputKind::kCooked, cooked),
                                      {OutputKind::kShownObj, obj},
                                      {OutputKind::kShownGlb, glb}}) {
    for (const std::string& found : {cooked, obj, glb, other, std::string("\x89"), std::string()}) {
      const fs::path output = folder.write("out", found);
      const bool is_fine = found.empty() || found == content;
      EXPECT_EQ(check_replaced(output, kind).code(), is_fine ? Errc::kOk : Errc::kWriteFailed)
          << found;
    }
    EXPECT_TRUE(check_replaced(folder.path() / "new", kind).ok());
    EXPECT_TRUE(check_replaced("/dev/null", kind).ok());
  }
}

}  // namespace
}  // namespace boxtree::cooker
