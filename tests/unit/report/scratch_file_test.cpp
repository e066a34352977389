// SPDX-License-Identifier: MIT
// A file to be opened by a path, for which no folder is needed.
#include "cooker/report/scratch_file.h"

#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "runtime/file/mapping.h"
#include "tests/support/temp_folder.h"

namespace boxtree::cooker {
namespace {

TEST(ScratchFile, IsReadAndMappedByItsPath) {
  const std::string text = "measured";
  const Result<ScratchFile> file = ScratchFile::create(std::as_bytes(std::span(text)));
  ASSERT_TRUE(file.ok()) << file.error().message();
  EXPECT_EQ(test::read_text(file->path()), text);
  const Result<Mapping> mapped = Mapping::map(file->path().string());
  ASSERT_TRUE(mapped.ok()) << mapped.error().message();
  EXPECT_EQ(mapped->bytes().size(), text.size());
}

TEST(ScratchFile, NeedsNoFolderForTemporaryFiles) {
  ::setenv("TMPDIR", "/proc", 1);
  const Result<ScratchFile> file = ScratchFile::create({});
  ::unsetenv("TMPDIR");
  EXPECT_TRUE(file.ok()) << file.error().message();
}

}  // namespace
}  // namespace boxtree::cooker
