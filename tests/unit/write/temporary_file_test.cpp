// SPDX-License-Identifier: MIT
// A name only while it is requested, and no litter, of this owner's or of a dead one's.
#ifndef _WIN32
#include "cooker/write/temporary_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

#include <gtest/gtest.h>

#include "tests/support/temp_folder.h"

namespace boxtree::cooker {
namespace {

constexpr mode_t kMode = 0600;

TEST(TemporaryFile, HasItsNameUntilThatIsTakenAway) {
  const test::TempFolder folder;
  Result<TemporaryFile> file = TemporaryFile::create(folder.path(), "out", kMode);
  ASSERT_TRUE(file.ok()) << file.error().message();
  ASSERT_TRUE(file->add_name().ok());
  EXPECT_TRUE(file->is_named());
  EXPECT_EQ(file->path().parent_path(), folder.path());
  struct stat by_name {};
  struct stat by_descriptor {};
  ASSERT_EQ(::stat(file->path().c_str(), &by_name), 0);
  ASSERT_EQ(::fstat(file->descriptor(), &by_descriptor), 0);
  EXPECT_EQ(by_name.st_ino, by_descriptor.st_ino);
  EXPECT_EQ(by_name.st_mode & 07777u, kMode);
  file->remove_name();
  EXPECT_FALSE(file->is_named());
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  EXPECT_EQ(::write(file->descriptor(), "x", 1), 1);
}

TEST(TemporaryFile, GoesWithItsOwnerWhereverThatMoved) {
  const test::TempFolder folder;
  {
    Result<TemporaryFile> first = TemporaryFile::create(folder.path(), "out", kMode);
    ASSERT_TRUE(first->add_name().ok());
    const TemporaryFile second = std::move(*first);
    EXPECT_TRUE(std::filesystem::exists(second.path()));
    EXPECT_FALSE(first->is_named());
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(TemporaryFile, ANameThatMovedAwayIsNotRemoved) {
  const test::TempFolder folder;
  {
    Result<TemporaryFile> file = TemporaryFile::create(folder.path(), "out", kMode);
    ASSERT_TRUE(file->add_name().ok());
    std::filesystem::rename(file->path(), folder.path() / "out");
    file->release_name();
    const auto reused = folder.write(file->path().filename().string(), "another's by now");
    EXPECT_EQ(reused, file->path());
  }
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "out"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2);
}

TEST(TemporaryFile, SweepsWhatDeadOwnersLeftAndNothingElse) {
  const test::TempFolder folder;
  const auto dead = folder.write(".out.0123456789abcdef.cooking", "litter");
  const auto living = folder.write(".out.fedcba9876543210.cooking", "at work");
  const auto notes = folder.write(".out.notes.cooking", "not ours");
  const auto other = folder.write(".other.0123456789abcdef.cooking", "another's to sweep");
  const int owner = ::open(living.c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(::flock(owner, LOCK_EX), 0);
  ASSERT_TRUE(TemporaryFile::create(folder.path(), "out", kMode).ok());
  EXPECT_FALSE(std::filesystem::exists(dead));
  EXPECT_TRUE(std::filesystem::exists(living));
  EXPECT_TRUE(std::filesystem::exists(notes));
  EXPECT_TRUE(std::filesystem::exists(other));
  ::close(owner);
}

// On NFS the sweep needs more than to read; elsewhere that is enough.
TEST(TemporaryFile, SweepsWhatItMayOnlyRead) {
  const test::TempFolder folder;
  const auto dead = folder.write(".out.0123456789abcdef.cooking", "litter");
  ASSERT_EQ(::chmod(dead.c_str(), 0400), 0);
  ASSERT_TRUE(TemporaryFile::create(folder.path(), "out", kMode).ok());
  EXPECT_FALSE(std::filesystem::exists(dead));
}

TEST(TemporaryFile, AFolderThatRefusesIsNamed) {
  const Result<TemporaryFile> file = TemporaryFile::create("/proc", "out", kMode);
  EXPECT_EQ(file.code(), Errc::kWriteFailed);
  EXPECT_NE(file.error().message().find("/proc/out"), std::string::npos) << file.error().message();
}

}  // namespace
}  // namespace boxtree::cooker
#endif
