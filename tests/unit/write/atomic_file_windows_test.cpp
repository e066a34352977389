// SPDX-License-Identifier: MIT
// The atomic writer on Windows: names in UTF-8, targets that others have open, and what the dead
// left.
#ifdef _WIN32
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "cooker/system/memory_file.h"
#include "cooker/system/write_all.h"
#include "cooker/write/file_writer.h"
#include "runtime/file/mapping.h"
#include "runtime/file/windows_path.h"
#include "tests/support/temp_folder.h"
#include "tests/unit/write/written.h"

namespace boxtree::cooker {
namespace {

using test::bytes_of;
using test::entries;

std::string text_of(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// A file that somebody has open, and shares as it is said.
class Opened {
 public:
  Opened(const std::filesystem::path& path, DWORD share)
      : handle_(::CreateFileW(path.c_str(), GENERIC_READ, share, nullptr, OPEN_EXISTING,
                              FILE_ATTRIBUTE_NORMAL, nullptr)) {
    EXPECT_NE(handle_, INVALID_HANDLE_VALUE);
  }
  Opened(const Opened&) = delete;
  Opened& operator=(const Opened&) = delete;
  ~Opened() { ::CloseHandle(handle_); }

 private:
  HANDLE handle_;
};

Status replace(const std::filesystem::path& target, std::string_view text) {
  Result<AtomicFile> file = AtomicFile::create(target);
  if (!file) return file.error();
  if (Status status = file->write(bytes_of(text)); !status) return status;
  return file->commit();
}

TEST(AtomicFileOnWindows, AReaderKeepsTheOldFileThatItHasMapped) {
  const test::TempFolder folder;
  const auto target = folder.write("out", "old bytes");
  {
    const Result<Mapping> reader = Mapping::map(target.string());
    ASSERT_TRUE(reader.ok()) << reader.error().message();
    const Status status = replace(target, "new");
    ASSERT_TRUE(status.ok()) << status.error().message();
    EXPECT_EQ(text_of(reader->bytes()), "old bytes");
    EXPECT_EQ(test::read_text(target), "new");
  }
  // Where the old file could not be deleted as long as it was mapped, the next writer does it.
  ASSERT_TRUE(replace(target, "newer").ok());
  EXPECT_EQ(test::read_text(target), "newer");
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(AtomicFileOnWindows, WhatCannotBeReplacedStaysAndIsNamed) {
  const test::TempFolder folder;
  const auto target = folder.write("out", "old");
  {
    const Opened unshared(target, FILE_SHARE_READ);  // may be neither renamed nor deleted
    const Status status = replace(target, "new");
    EXPECT_EQ(status.code(), Errc::kWriteFailed);
    EXPECT_NE(status.error().detail.find(target.string() + ": cannot rename: "), std::string::npos)
        << status.error().detail;
  }
  EXPECT_EQ(test::read_text(target), "old");
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(AtomicFileOnWindows, SweepsWhatDeadWritersLeftAndNothingElse) {
  const test::TempFolder folder;
  const auto target = folder.write("out", "old");
  const auto dead = folder.write(".out.0123456789abcdef.cooking", "litter");
  const auto living = folder.write(".out.fedcba9876543210.cooking", "at work");
  const auto notes = folder.write(".out.notes.cooking", "not ours");
  const Opened writer(living, FILE_SHARE_READ);
  ASSERT_TRUE(AtomicFile::create(target).ok());
  EXPECT_FALSE(std::filesystem::exists(dead));
  EXPECT_TRUE(std::filesystem::exists(living));
  EXPECT_TRUE(std::filesystem::exists(notes));
  EXPECT_EQ(test::read_text(target), "old");
}

TEST(AtomicFileOnWindows, AFileInMemoryIsMappedAndGone) {
  const int file = open_memory_file();
  ASSERT_GE(file, 0);
  ASSERT_TRUE(write_all(file, bytes_of("bytes")));
  const Result<Mapping> mapped = Mapping::map(file, "memory");
  ASSERT_TRUE(mapped.ok()) << mapped.error().message();
  EXPECT_EQ(text_of(mapped->bytes()), "bytes");
  ::close(file);
}

}  // namespace
}  // namespace boxtree::cooker
#endif
