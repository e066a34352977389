// SPDX-License-Identifier: MIT
// What POSIX and Linux say of files that are opened: pipes, and pages that are mapped. Compiled on
// Windows, this is nothing: see tests/platforms/windows_files.c.
#ifndef _WIN32
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <sys/mman.h>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "runtime/file/mapping.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/temp_folder.h"
#include "tests/unit/file/cooked_pages.h"

namespace boxtree {
namespace {

TEST(FileOpen, PipesAreRefusedWithoutWaiting) {
  const test::TempFolder folder;
  const std::filesystem::path pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(File::open(pipe).code(), Errc::kFileUnreadable);
}

// What the system says of the pages that a file is mapped to.
struct MappedPages {
  std::size_t resident_kilobytes = 0;
  std::string flags;  // "rd mr mw me sr"
};

MappedPages pages_of(Bytes bytes) {
  std::ostringstream first;
  first << std::hex << reinterpret_cast<std::uintptr_t>(bytes.data()) << '-';
  std::ifstream maps("/proc/self/smaps");
  MappedPages pages;
  bool is_found = false;
  for (std::string line; std::getline(maps, line);) {
    is_found |= line.starts_with(first.str());
    if (!is_found) continue;
    if (line.starts_with("Rss:")) pages.resident_kilobytes = std::stoul(line.substr(4));
    if (!line.starts_with("VmFlags:")) continue;
    pages.flags = line.substr(8);
    return pages;
  }
  ADD_FAILURE() << "no mapping at " << first.str();
  return pages;
}

TEST(FileAdvice, ReachesTheSystem) {
  const test::TempFolder folder;
  const Result<File> file = File::open(folder.write("terrain.bxt", test::cooked_pages()));
  ASSERT_TRUE(file.ok());
  const auto flags_after = [&](Access access) {
    EXPECT_TRUE(file->advise(access));
    return pages_of(file->bytes()).flags;
  };
  EXPECT_NE(flags_after(Access::kRandom).find(" rr"), std::string::npos);
  EXPECT_EQ(flags_after(Access::kSequential).find(" rr"), std::string::npos);
  EXPECT_NE(flags_after(Access::kSequential).find(" sr"), std::string::npos);
  EXPECT_EQ(flags_after(Access::kNormal).find(" sr"), std::string::npos);
}

TEST(FileAdvice, GivesMemoryBack) {
  const test::TempFolder folder;
  const Result<File> file = File::open(folder.write("terrain.bxt", test::cooked_pages()));
  ASSERT_TRUE(file.ok() && verify_checksums(*file).ok());
  EXPECT_GE(pages_of(file->bytes()).resident_kilobytes, file->bytes().size() / 1024);
  EXPECT_TRUE(file->advise(Access::kDontNeed));
  EXPECT_EQ(pages_of(file->bytes()).resident_kilobytes, 0u);
  EXPECT_TRUE(verify_checksums(*file).ok());
}

TEST(FileAdvice, LoadsTheFile) {
  const test::TempFolder folder;
  const std::filesystem::path path = folder.write("terrain.bxt", test::cooked_pages());
  const Result<File> file = File::open(path);
  ASSERT_TRUE(file.ok());
  // Out of the page cache, from which no page goes that is mapped.
  ASSERT_TRUE(file->advise(Access::kDontNeed));
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  EXPECT_EQ(::fsync(descriptor), 0);
  EXPECT_EQ(::posix_fadvise(descriptor, 0, 0, POSIX_FADV_DONTNEED), 0);
  ::close(descriptor);
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  const std::size_t pages = (file->bytes().size() + page - 1) / page;
  const auto cached = [&] {
    std::vector<unsigned char> is_cached(pages);
    EXPECT_EQ(::mincore(const_cast<std::byte*>(file->bytes().data()), file->bytes().size(),
                        is_cached.data()),
              0);
    return static_cast<std::size_t>(std::count_if(
        is_cached.begin(), is_cached.end(), [](unsigned char flags) { return (flags & 1u) != 0; }));
  };
  if (cached() == pages) GTEST_SKIP() << "the file system keeps its files in memory";
  ASSERT_TRUE(file->advise(Access::kWillNeed));
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (cached() < pages && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(cached(), pages);
}

// What a file is mapped from moves with it.
TEST(FileAdvice, FollowsAFileThatMoves) {
  const test::TempFolder folder;
  const std::string whole = test::cooked_pages();
  Result<File> mapped = File::open(folder.write("terrain.bxt", whole));
  OpenOptions options;
  options.copy = true;
  Result<File> copied = File::open(folder.write("copied.bxt", whole), options);
  ASSERT_TRUE(mapped.ok() && copied.ok());
  File first = std::move(*mapped);
  File second = std::move(*copied);
  EXPECT_TRUE(first.advise(Access::kDontNeed));
  EXPECT_FALSE(second.advise(Access::kDontNeed));
  std::swap(first, second);
  EXPECT_FALSE(first.advise(Access::kDontNeed));
  EXPECT_TRUE(second.advise(Access::kDontNeed));
  EXPECT_TRUE(verify_checksums(first).ok());
}

// Of the whole process.
std::size_t mapped_pages() {
  std::ifstream sizes("/proc/self/statm");
  std::size_t pages = 0;
  sizes >> pages;
  return pages;
}

TEST(FileCopy, OfManyPagesIsInHugeOnes) {
  if (!std::filesystem::exists("/sys/kernel/mm/transparent_hugepage/enabled")) {
    GTEST_SKIP() << "the system has no huge pages";
  }
  const test::TempFolder folder;
  std::string text(9'000'123, '.');
  for (std::size_t i = 0; i < text.size(); i += 997) text[i] = static_cast<char>(i / 997 % 251);
  const std::filesystem::path path = folder.write("large", text);
  const auto is_text = [&](Bytes bytes) {
    return bytes.size() == text.size() && std::memcmp(bytes.data(), text.data(), text.size()) == 0;
  };
  std::size_t at_first = 0;
  for (int i = 0; i < 64; ++i) {
    const Result<Mapping> copy = Mapping::copy(path);
    ASSERT_TRUE(copy.ok());
    const Bytes bytes = copy->bytes();
    EXPECT_NE(pages_of(bytes).flags.find(" hg"), std::string::npos);
    EXPECT_TRUE(is_text(bytes));
    if (i == 0) at_first = mapped_pages();
  }
  // Nothing of 64 copies is left.
  EXPECT_LT(mapped_pages(),
            at_first + text.size() / static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)));
}

}  // namespace
}  // namespace boxtree
#endif
