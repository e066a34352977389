// SPDX-License-Identifier: MIT
// Opening by path: what is refused and how it is named, and what a copy is immune to.
#include <algorithm>
#include <chrono>
#include <fcntl.h>
#include <fstream>
#include <sstream>
#include <sys/mman.h>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

#include <gtest/gtest.h>

#include "runtime/tree/bound_tree.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/temp_folder.h"

namespace boxtree {
namespace {

std::string cooked_text() {
  const std::vector<std::byte> bytes = test::cook_bytes(test::torus(8, 6), CodecId::kPlainF16);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST(FileOpen, NamesThePathOfWhatItRefuses) {
  const test::TempFolder folder;
  struct Case {
    std::filesystem::path path;
    Errc expected;
  };
  const std::string whole = cooked_text();
  const Case cases[] = {
      {folder.path() / "missing.bxt", Errc::kFileNotFound},
      {folder.path(), Errc::kFileUnreadable},
      {folder.write("empty.bxt", ""), Errc::kTruncated},
      {folder.write("short.bxt", whole.substr(0, 63)), Errc::kTruncated},
      {folder.write("cut.bxt", whole.substr(0, whole.size() - 64)), Errc::kTruncated},
      {folder.write("text.bxt", std::string(200, 'x')), Errc::kBadMagic},
      {folder.write("magic.bxt", whole.substr(0, 5)), Errc::kTruncated},
      {folder.write("small.obj", "v 0 0 0\nv 1 0 0\n"), Errc::kBadMagic},
      {folder.write("byte.obj", "v"), Errc::kBadMagic},
      {folder.write("damaged.bxt", whole.substr(0, 4) + "x"), Errc::kBadMagic},
  };
  for (const Case& c : cases) {
    for (const bool copy : {false, true}) {
      OpenOptions options;
      options.copy = copy;
      const Result<File> file = File::open(c.path, options);
      ASSERT_EQ(file.code(), c.expected) << c.path;
      EXPECT_NE(file.error().detail.find(c.path.string()), std::string::npos)
          << file.error().detail;
    }
  }
}

// The same name and words wherever a file is looked for, also where a file is in the place of a
// folder.
TEST(FileOpen, MissingFileHasOneMessage) {
  const test::TempFolder folder;
  const std::filesystem::path file = folder.write("file", "x");
  for (const std::filesystem::path& path : {folder.path() / "missing.bxt", file / "missing.bxt"}) {
    EXPECT_EQ(File::open(path).error().message(),
              "file_not_found: " + path.string() + ": no such file; check the name");
  }
  EXPECT_EQ(File::open("missing.bxt").error().message(),
            "file_not_found: missing.bxt: no such file; check the name, which is relative to the "
            "current folder");
}

TEST(FileOpen, PipesAreRefusedWithoutWaiting) {
  const test::TempFolder folder;
  const std::filesystem::path pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(File::open(pipe).code(), Errc::kFileUnreadable);
}

TEST(FileOpen, MapAndCopyAndMemoryAgree) {
  const test::TempFolder folder;
  const std::string whole = cooked_text();
  const std::filesystem::path path = folder.write("torus.bxt", whole);
  // Records are read at any alignment: one byte off on purpose.
  const std::string shifted = "x" + whole;
  OpenOptions copy;
  copy.copy = true;
  copy.verify_checksums = true;
  for (const Result<File>& file : {File::open(path), File::open(path, copy),
                                   File::open(std::as_bytes(std::span(shifted)).subspan(1))}) {
    ASSERT_TRUE(file.ok()) << file.error().message();
    const Result<Tree> tree = Tree::bind(*file);
    ASSERT_TRUE(tree.ok());
    const auto hit = closest_hit(*tree, {{1, 0.01, 9}, {0, 0, -1}});
    ASSERT_TRUE(hit.ok() && hit.has_value());
  }
}

TEST(FileOpen, ACopyOutlivesItsFile) {
  const test::TempFolder folder;
  const std::filesystem::path path = folder.write("torus.bxt", cooked_text());
  OpenOptions options;
  options.copy = true;
  const Result<File> file = File::open(path, options);
  ASSERT_TRUE(file.ok());
  std::filesystem::resize_file(path, 0);
  EXPECT_TRUE(verify_checksums(*file).ok());
}

// What the system says of the pages that a file is mapped to.
struct MappedPages {
  std::size_t resident_kilobytes = 0;
  std::string flags;  // "rd mr mw me sr"
};

MappedPages pages_of(const File& file) {
  std::ostringstream first;
  first << std::hex << reinterpret_cast<std::uintptr_t>(file.bytes().data()) << '-';
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

constexpr Access kEveryAccess[] = {Access::kRandom, Access::kSequential, Access::kNormal,
                                   Access::kWillNeed, Access::kDontNeed};

std::string cooked_pages() {
  const std::vector<std::byte> bytes = test::cook_bytes(test::terrain(60, 1), CodecId::kWide8);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST(FileAdvice, ReachesTheSystem) {
  const test::TempFolder folder;
  const Result<File> file = File::open(folder.write("terrain.bxt", cooked_pages()));
  ASSERT_TRUE(file.ok());
  const auto flags_after = [&](Access access) {
    EXPECT_TRUE(file->advise(access));
    return pages_of(*file).flags;
  };
  EXPECT_NE(flags_after(Access::kRandom).find(" rr"), std::string::npos);
  EXPECT_EQ(flags_after(Access::kSequential).find(" rr"), std::string::npos);
  EXPECT_NE(flags_after(Access::kSequential).find(" sr"), std::string::npos);
  EXPECT_EQ(flags_after(Access::kNormal).find(" sr"), std::string::npos);
}

TEST(FileAdvice, GivesMemoryBack) {
  const test::TempFolder folder;
  const Result<File> file = File::open(folder.write("terrain.bxt", cooked_pages()));
  ASSERT_TRUE(file.ok() && verify_checksums(*file).ok());
  EXPECT_GE(pages_of(*file).resident_kilobytes, file->bytes().size() / 1024);
  EXPECT_TRUE(file->advise(Access::kDontNeed));
  EXPECT_EQ(pages_of(*file).resident_kilobytes, 0u);
  EXPECT_TRUE(verify_checksums(*file).ok());
}

TEST(FileAdvice, LoadsTheFile) {
  const test::TempFolder folder;
  const std::filesystem::path path = folder.write("terrain.bxt", cooked_pages());
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

// The system would take kDontNeed of a copy, too, and its bytes would be zeros afterwards.
TEST(FileAdvice, DoesNothingInMemory) {
  const test::TempFolder folder;
  const std::string whole = cooked_pages();
  OpenOptions copy;
  copy.copy = true;
  for (const Result<File>& opened : {File::open(folder.write("terrain.bxt", whole), copy),
                                     File::open(std::as_bytes(std::span(whole)))}) {
    ASSERT_TRUE(opened.ok());
    for (const Access access : kEveryAccess) EXPECT_FALSE(opened->advise(access));
    EXPECT_TRUE(verify_checksums(*opened).ok());
  }
}

// What a file is mapped from moves with it.
TEST(FileAdvice, FollowsAFileThatMoves) {
  const test::TempFolder folder;
  const std::string whole = cooked_pages();
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

TEST(FileTrees, AreFoundByNumberAndName) {
  std::vector<cooker::EncodedTree> trees;
  for (const cooker::SourceMesh& mesh : {test::torus(8, 6), test::sphere(6, 8)}) {
    trees.push_back(std::move(cooker::cook_mesh(mesh, {})->tree));
  }
  const std::vector<std::byte> bytes = cooker::serialize(trees);
  const Result<File> file = File::open(Bytes(bytes));
  ASSERT_TRUE(file.ok());
  ASSERT_EQ(file->tree_count(), 2u);
  EXPECT_EQ(file->tree_name(0), "torus");
  EXPECT_EQ(file->tree_name(1), "sphere");
  EXPECT_EQ(*file->find_tree("sphere"), 1u);
  EXPECT_EQ(file->find_tree("cube").code(), Errc::kTreeIndex);
  EXPECT_EQ(Tree::bind(*file, 2).error().message(),
            "tree_index: there is no tree 2; expected 0 or 1");
  EXPECT_EQ(BoundTree::of(*Tree::bind(*file, 1)).face_count(), trees[1].face_count);
}

}  // namespace
}  // namespace boxtree
