// SPDX-License-Identifier: MIT
// What is left behind when writing fails, is abandoned or is killed: the old file and nothing else.
#include <filesystem>
#include <span>

#include <gtest/gtest.h>

#include "cooker/write/file_writer.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/temp_folder.h"
#include "tests/unit/write/written.h"

namespace boxtree::cooker {
namespace {

using test::bytes_of;
using test::entries;

TEST(AtomicFile, CommitsTheWholeAndReplacesTheOld) {
  const test::TempFolder folder;
  const auto target = folder.write("out", "old");
  {
    Result<AtomicFile> file = AtomicFile::create(target);
    ASSERT_TRUE(file.ok()) << file.error().message();
    ASSERT_TRUE(file->write(bytes_of("ne")).ok());
    ASSERT_TRUE(file->write(bytes_of("w")).ok());
    EXPECT_EQ(test::read_text(target), "old");
    ASSERT_TRUE(file->commit().ok());
  }
  EXPECT_EQ(test::read_text(target), "new");
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(AtomicFile, AbandonedLeavesTheOldAndNoLitter) {
  const test::TempFolder folder;
  const auto target = folder.write("out", "old");
  {
    Result<AtomicFile> file = AtomicFile::create(target);
    ASSERT_TRUE(file->write(bytes_of("new")).ok());
  }
  EXPECT_EQ(test::read_text(target), "old");
  EXPECT_EQ(entries(folder.path()), 1u);
}

// Whatever names the writers' processes have: each has a temporary of its own.
TEST(AtomicFile, TwoWritersOfOneTargetDoNotMix) {
  const test::TempFolder folder;
  const auto target = folder.path() / "out";
  Result<AtomicFile> first = AtomicFile::create(target);
  Result<AtomicFile> second = AtomicFile::create(target);
  ASSERT_TRUE(first->write(bytes_of("first")).ok());
  ASSERT_TRUE(second->write(bytes_of("the second")).ok());
  ASSERT_TRUE(second->commit().ok());
  EXPECT_EQ(test::read_text(target), "the second");
  ASSERT_TRUE(first->commit().ok());
  EXPECT_EQ(test::read_text(target), "first");
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(AtomicFile, NoFolderNoFile) {
  const test::TempFolder folder;
  EXPECT_EQ(AtomicFile::create(folder.path() / "missing" / "out").code(), Errc::kWriteFailed);
  EXPECT_EQ(AtomicFile::create(folder.path()).code(), Errc::kWriteFailed);
}

// The proof stands between the bytes and the target: a tree that loses a face is not released.
TEST(WriteFile, ATreeThatDoesNotHoldIsNotReleased) {
  const test::TempFolder folder;
  const auto target = folder.write("torus.bxt", "old");
  Result<CookedTree> cooked = cook_mesh(test::torus(24, 16), {});
  cooked->tree.nodes.root_box.high[0] -= 1;
  const Result<std::uint64_t> status = write_file(target, {std::span(&cooked->tree, 1), {}});
  EXPECT_EQ(status.code(), Errc::kBoxEscape) << status.error().message();
  EXPECT_EQ(test::read_text(target), "old");
  EXPECT_EQ(entries(folder.path()), 1u);
}

}  // namespace
}  // namespace boxtree::cooker
