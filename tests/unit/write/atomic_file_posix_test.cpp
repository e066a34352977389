// SPDX-License-Identifier: MIT
// The same where writers are killed, disks are full, and targets are links or streams.
#ifndef _WIN32
#include <array>
#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <span>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

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

TEST(AtomicFile, KilledLeavesTheOldAndNoLitter) {
  const test::TempFolder folder;
  const auto target = folder.write("out", "old");
  int ready[2];
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    Result<AtomicFile> file = AtomicFile::create(target);
    const bool written = file.ok() && file->write(bytes_of("half of it")).ok();
    static_cast<void>(!::write(ready[1], written ? "y" : "n", 1));
    ::pause();  // until killed
    ::_exit(0);
  }
  char answer = 'n';
  ASSERT_EQ(::read(ready[0], &answer, 1), 1);
  EXPECT_EQ(answer, 'y');
  ASSERT_EQ(::kill(child, SIGKILL), 0);
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  ::close(ready[0]);
  ::close(ready[1]);
  EXPECT_EQ(test::read_text(target), "old");
  // Where the file system has no unnamed files, the next writer sweeps.
  ASSERT_TRUE(AtomicFile::create(target)->commit().ok());
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(AtomicFile, SweepsWhatDeadWritersLeftAndNothingElse) {
  const test::TempFolder folder;
  const auto target = folder.write("out", "old");
  const auto dead = folder.write(".out.0123456789abcdef.cooking", "litter");
  const auto living = folder.write(".out.fedcba9876543210.cooking", "at work");
  const auto other = folder.write(".out.notes.cooking", "not ours");
  const int writer = ::open(living.c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(::flock(writer, LOCK_EX), 0);
  ASSERT_TRUE(AtomicFile::create(target).ok());
  EXPECT_FALSE(std::filesystem::exists(dead));
  EXPECT_TRUE(std::filesystem::exists(living));
  EXPECT_TRUE(std::filesystem::exists(other));
  ::close(writer);
}

TEST(AtomicFile, LinksStayLinksAndModesStay) {
  const test::TempFolder folder;
  const auto target = folder.write("real", "old");
  ASSERT_EQ(::chmod(target.c_str(), 0640), 0);
  std::filesystem::create_directory(folder.path() / "sub");
  const auto link = folder.path() / "sub" / "link";
  std::filesystem::create_symlink("../real", link);
  Result<AtomicFile> file = AtomicFile::create(link);
  ASSERT_TRUE(file->write(bytes_of("new")).ok());
  ASSERT_TRUE(file->commit().ok());
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(test::read_text(target), "new");
  struct stat status {};
  ASSERT_EQ(::stat(target.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777u, 0640u);

  const auto dangling = folder.path() / "dangling";
  std::filesystem::create_symlink("not_yet", dangling);
  ASSERT_TRUE(AtomicFile::create(dangling)->commit().ok());
  EXPECT_TRUE(std::filesystem::is_regular_file(folder.path() / "not_yet"));
  const auto loop = folder.path() / "loop";
  std::filesystem::create_symlink("loop", loop);
  EXPECT_EQ(AtomicFile::create(loop).code(), Errc::kWriteFailed);
}

TEST(AtomicFile, NamesMayBeAsLongAsTheSystemAllows) {
  const test::TempFolder folder;
  for (const std::size_t length : {200u, 244u, 255u}) {
    const auto target = folder.path() / std::string(length, 'n');
    ASSERT_TRUE(AtomicFile::create(target)->commit().ok()) << length;
    EXPECT_TRUE(std::filesystem::exists(target));
  }
}

// After the rename it would be too late to find out.
TEST(AtomicFile, CommitNeedsNoMoreDescriptors) {
  const test::TempFolder folder;
  const auto target = folder.write("out", "old");
  Result<AtomicFile> file = AtomicFile::create(target);
  rlimit old{};
  ::getrlimit(RLIMIT_NOFILE, &old);
  const rlimit none{0, old.rlim_max};
  ::setrlimit(RLIMIT_NOFILE, &none);
  const Status status = file->commit();
  ::setrlimit(RLIMIT_NOFILE, &old);
  EXPECT_TRUE(status.ok());
}

// What is written to a stream is whole before its first byte is there.
TEST(AtomicFile, StreamGetsTheBytesWhenTheyAreCommitted) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe2(ends.data(), O_CLOEXEC | O_NONBLOCK), 0);
  const OutputTarget target("out.bxt", OutputStream{ends[1], "standard output"});
  EXPECT_EQ(target.title(), "standard output");
  std::array<char, 8> read{};
  {
    Result<AtomicFile> file = AtomicFile::create(target);
    ASSERT_TRUE(file.ok()) << file.error().message();
    ASSERT_TRUE(file->write(std::as_bytes(std::span("abc", 3))).ok());
  }
  EXPECT_LT(::read(ends[0], read.data(), read.size()), 0) << "an abandoned file was sent";
  Result<AtomicFile> file = AtomicFile::create(target);
  ASSERT_TRUE(file.ok()) << file.error().message();
  ASSERT_TRUE(file->write(std::as_bytes(std::span("abc", 3))).ok());
  EXPECT_LT(::read(ends[0], read.data(), read.size()), 0);
  ASSERT_TRUE(file->commit().ok());
  EXPECT_EQ(::read(ends[0], read.data(), read.size()), 3);
  EXPECT_STREQ(read.data(), "abc");
  ::close(ends[0]);
  ::close(ends[1]);
  EXPECT_FALSE(std::filesystem::exists("out.bxt"));
}

TEST(AtomicFile, StreamThatTakesNothingIsNamed) {
  const int closed = ::open("/dev/null", O_RDONLY | O_CLOEXEC);  // not for writing
  Result<AtomicFile> file =
      AtomicFile::create(OutputTarget("out.bxt", OutputStream{closed, "standard output"}));
  ASSERT_TRUE(file.ok()) << file.error().message();
  ASSERT_TRUE(file->write(std::as_bytes(std::span("abc", 3))).ok());
  const Status sent = file->commit();
  EXPECT_EQ(sent.code(), Errc::kWriteFailed);
  EXPECT_EQ(sent.error().detail.find("standard output: cannot be written: "), 0u);
  ::close(closed);
}

// A limit on file size stands for a full disk: write() fails half-way.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    old_handler_ = ::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit{bytes, old_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &old_);
    ::signal(SIGXFSZ, old_handler_);
  }

 private:
  rlimit old_{};
  void (*old_handler_)(int) = nullptr;
};

TEST(WriteFile, FullDiskLeavesTheOldAndNamesTheFile) {
  const test::TempFolder folder;
  const auto target = folder.write("torus.bxt", "old");
  const Result<CookedTree> cooked = cook_mesh(test::torus(24, 16), {});
  Status status;
  {
    const FullDisk full(4096);
    const Result<std::uint64_t> written = write_file(target, {std::span(&cooked->tree, 1), "{}\n"});
    status = written ? Status() : Status(written.error());
  }
  ASSERT_EQ(status.code(), Errc::kWriteFailed);
  EXPECT_NE(status.error().detail.find(target.string()), std::string::npos);
  EXPECT_EQ(test::read_text(target), "old");
  EXPECT_EQ(entries(folder.path()), 1u);
  ASSERT_TRUE(write_file(target, {std::span(&cooked->tree, 1), "{}\n"}).ok());
  EXPECT_TRUE(File::open(target).ok());
}

}  // namespace
}  // namespace boxtree::cooker
#endif
