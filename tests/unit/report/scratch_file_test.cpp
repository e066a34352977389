// SPDX-License-Identifier: MIT
// Nothing in the temporary folder, while it lives and after; what a killed process left is swept.
#include "cooker/report/scratch_file.h"

#include <cstdlib>

#include <gtest/gtest.h>

#include "tests/support/temp_folder.h"

namespace boxtree::cooker {
namespace {

class TemporaryFolder {
 public:
  TemporaryFolder() { ::setenv("TMPDIR", folder_.path().c_str(), 1); }
  ~TemporaryFolder() { ::unsetenv("TMPDIR"); }
  [[nodiscard]] const test::TempFolder& operator*() const { return folder_; }
  [[nodiscard]] bool is_empty() const { return std::filesystem::is_empty(folder_.path()); }

 private:
  test::TempFolder folder_;
};

TEST(ScratchFile, IsReadByItsPathAndLeavesNothing) {
  const TemporaryFolder folder;
  const std::string text = "measured";
  {
    const Result<ScratchFile> file = ScratchFile::create(std::as_bytes(std::span(text)));
    ASSERT_TRUE(file.ok()) << file.error().message();
    EXPECT_EQ(test::read_text(file->path()), text);
    EXPECT_TRUE(folder.is_empty());
  }
  EXPECT_TRUE(folder.is_empty());
}

// Where a file cannot be made without a name it has one between two system calls.
TEST(ScratchFile, SweepsWhatAKilledProcessLeft) {
  const TemporaryFolder folder;
  (*folder).write(".boxtree-scratch.0123456789abcdef.cooking", "litter");
  ASSERT_TRUE(ScratchFile::create({}).ok());
  EXPECT_TRUE(folder.is_empty());
}

TEST(ScratchFile, SaysWhichFolderRefuses) {
  const TemporaryFolder folder;
  ::setenv("TMPDIR", "/proc", 1);
  const Result<ScratchFile> file = ScratchFile::create({});
  EXPECT_EQ(file.code(), Errc::kWriteFailed);
  EXPECT_NE(file.error().message().find("/proc"), std::string::npos) << file.error().message();
}

}  // namespace
}  // namespace boxtree::cooker
