// SPDX-License-Identifier: MIT
// A journal can cost time and never a wrong output: each way in which it, or an output, is damaged.
#include "cooker/farm/journal.h"

#include <chrono>
#include <fstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/require.h"
#include "tests/support/temp_folder.h"
#include "tests/unit/farm/cache_values.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;
using test::require;

using test::kKey;

Journal::Entry entry_of(const std::string& bytes) {
  return {kKey, sha256_of(bytes), bytes.size()};
}

TEST(Journal, KnowsWhatWasFinishedAndIsStillThere) {
  const test::TempFolder folder;
  const fs::path path = folder.path() / "j", output = folder.write("a b%.bxt", "bytes");
  {
    Journal journal = require(Journal::open(path));
    EXPECT_FALSE(journal.find(output, kKey));
    ASSERT_TRUE(journal.add(output, entry_of("bytes")));
  }
  EXPECT_TRUE(require(Journal::open(path)).find(output, kKey));
  EXPECT_FALSE(require(Journal::open(path)).find(output, sha256_of("other")));
  folder.write("a b%.bxt", "bytez");  // as long
  EXPECT_FALSE(require(Journal::open(path)).find(output, kKey));
  folder.write("a b%.bxt", "byte");
  EXPECT_FALSE(require(Journal::open(path)).find(output, kKey));
  fs::remove(output);
  EXPECT_FALSE(require(Journal::open(path)).find(output, kKey));
}

TEST(Journal, TheLastLineOfAnOutputCounts) {
  const test::TempFolder folder;
  const fs::path path = folder.path() / "j", output = folder.write("o", "new");
  {
    Journal journal = require(Journal::open(path));
    ASSERT_TRUE(journal.add(output, entry_of("new")));
    Journal::Entry newer = entry_of("new");
    newer.key = sha256_of("newer");
    ASSERT_TRUE(journal.add(output, newer));
  }
  EXPECT_FALSE(require(Journal::open(path)).find(output, kKey));
  EXPECT_TRUE(require(Journal::open(path)).find(output, sha256_of("newer")));
}

// A process is killed in mid-write: cut at every byte, its line counts as none, and the next one is
// whole.
TEST(Journal, ALineThatIsCutShortIsNone) {
  const test::TempFolder folder;
  const fs::path path = folder.path() / "j";
  const fs::path first = folder.write("first", "1"), second = folder.write("second", "22");
  {
    Journal journal = require(Journal::open(path));
    ASSERT_TRUE(journal.add(first, entry_of("1")));
    ASSERT_TRUE(journal.add(second, entry_of("22")));
  }
  const std::string text = test::read_text(path);
  const std::size_t start = text.find('\n') + 1;
  for (std::size_t end = start; end < text.size() - 1; ++end) {
    folder.write("j", text.substr(0, end));
    Journal journal = require(Journal::open(path));
    EXPECT_TRUE(journal.find(first, kKey));
    EXPECT_FALSE(journal.find(second, kKey)) << end;
    ASSERT_TRUE(journal.add(second, entry_of("22")));
  }
  EXPECT_TRUE(require(Journal::open(path)).find(second, kKey));
}

TEST(Journal, AnyChangedByteIsNoWrongOutput) {
  const test::TempFolder folder;
  const fs::path path = folder.path() / "j", output = folder.write("o", "bytes");
  {
    Journal journal = require(Journal::open(path));
    ASSERT_TRUE(journal.add(output, entry_of("bytes")));
  }
  const std::string text = test::read_text(path);
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string damaged = text;
    damaged[i] = static_cast<char>(damaged[i] ^ 1);
    folder.write("j", damaged);
    Journal journal = require(Journal::open(path));
    const auto found = journal.find(output, kKey);
    if (found) {
      EXPECT_EQ(found->output, sha256_of("bytes")) << i;
    }
  }
}

TEST(Journal, IsOfOneProcessAtATime) {
  const test::TempFolder folder;
  const fs::path path = folder.path() / "j";
  {
    const Journal journal = require(Journal::open(path));
    const auto second = Journal::open(path);
    EXPECT_EQ(second.code(), Errc::kWriteFailed);
    EXPECT_NE(second.error().detail.find("another process"), std::string::npos);
  }
  EXPECT_TRUE(Journal::open(path));
  EXPECT_EQ(Journal::open(folder.path() / "absent" / "j").code(), Errc::kWriteFailed);
}

TEST(Journal, LinesOfSeveralThreadsAreWhole) {
  const test::TempFolder folder;
  const fs::path path = folder.path() / "j", output = folder.write("o", "bytes");
  constexpr int kThreads = 4, kLines = 200;
  {
    Journal journal = require(Journal::open(path));
    std::vector<std::thread> threads;
    for (int t = 0; t < kThreads; ++t) {
      threads.emplace_back([&journal, t] {
        for (int i = 0; i < kLines; ++i) {
          static_cast<void>(journal.add(std::to_string(1000 * t + i), entry_of("bytes")));
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    ASSERT_TRUE(journal.add(output, entry_of("bytes")));
  }
  const std::string text = test::read_text(path);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), kThreads * kLines + 1);
  EXPECT_TRUE(require(Journal::open(path)).find(output, kKey));
}

// A line with the state that a file has now and the digest of other bytes, which digest_of gives if
// it reads nothing.
void remember(const fs::path& journal, const fs::path& file, const FileState& state) {
  const auto& n = state.numbers;
  std::ofstream(journal, std::ios::app)
      << fmt::format(R"({{"file":"{}","state":[{},{},{},{},{}],"sha256":"{}"}})", file.string(),
                     n[0], n[1], n[2], n[3], n[4], hex_of(sha256_of("remembered")))
      << '\n';
}

TEST(Journal, RemembersDigestsOfFilesWhoseStateIsTheSame) {
  const test::TempFolder folder;
  const fs::path path = folder.path() / "j", file = folder.write("f", "bytes");
  const FileState state = *state_of(file);
  remember(path, file, state);
  bool is_remembered = false;
  EXPECT_EQ(require(require(Journal::open(path)).digest_of(file, &is_remembered)),
            sha256_of("remembered"));
  EXPECT_TRUE(is_remembered);
  // Outputs, too, where that is wanted.
  const Journal::Entry entry{kKey, sha256_of("remembered"), 5};
  Journal journal = require(Journal::open(path));
  ASSERT_TRUE(journal.add(file, entry));
  EXPECT_TRUE(journal.find(file, kKey, true));
  EXPECT_FALSE(journal.find(file, kKey));
}

TEST(Journal, AnyOtherStateIsReadAnew) {
  const test::TempFolder folder;
  const fs::path file = folder.write("f", "bytes");
  for (std::size_t i = 0; i < 5; ++i) {
    const fs::path path = folder.path() / (std::to_string(i) + ".done");
    FileState state = *state_of(file);
    ++state.numbers[i];
    remember(path, file, state);
    bool is_remembered = false;
    EXPECT_EQ(require(require(Journal::open(path)).digest_of(file, &is_remembered)),
              sha256_of("bytes"));
    EXPECT_FALSE(is_remembered);
  }
  const fs::path path = folder.path() / "j";
  remember(path, file, *state_of(file));
  Journal journal = require(Journal::open(path));
  EXPECT_EQ(require(journal.digest_of(file)), sha256_of("remembered"));
  const auto time = fs::last_write_time(file);
  folder.write("f", "bytez");  // as long, with the time of before
  fs::last_write_time(file, time);
  EXPECT_EQ(require(journal.digest_of(file)), sha256_of("bytez"));
  fs::remove(file);
  EXPECT_EQ(journal.digest_of(file).code(), Errc::kFileNotFound);
}

// A mesh and what it refers to, found by readings that are counted.
class FilesOf : public ::testing::Test {
 protected:
  FilesOf() {
    folder_.write("m.obj", "mtllib a.mtl\nmtllib b.mtl\nmtllib sub/../c.mtl\nv 0 0 0\n");
    folder_.write("a.mtl", "newmtl a\n");
    fs::create_directory(folder_.path() / "sub");
    folder_.write("c.mtl", "newmtl c\n");
    settle();
  }
  // What has just been written is not remembered.
  static void settle() { std::this_thread::sleep_for(std::chrono::milliseconds(2100)); }
  std::vector<std::string> names(const std::vector<fs::path>& files) const {
    std::vector<std::string> names;
    for (const fs::path& file : files) names.push_back(file.filename().string());
    return names;
  }
  // The names, and whether they were found anew.
  std::pair<std::vector<std::string>, bool> list() {
    Journal journal = require(Journal::open(folder_.path() / "j"));
    const fs::path mesh = folder_.path() / "m.obj";
    bool is_read = false, is_remembered = false;
    const auto files = require(journal.files_of(
        mesh,
        [&] {
          is_read = true;
          return find_source_files(mesh);
        },
        &is_remembered));
    EXPECT_NE(is_read, is_remembered);
    return {names(files), is_read};
  }
  using Names = std::vector<std::string>;

  test::TempFolder folder_;
};

// Found by an audit: a run with nothing to do read each OBJ, and imported each glTF, for their
// names alone.
TEST_F(FilesOf, AreRememberedWhileAllThatDecidesThemIsTheSame) {
  EXPECT_EQ(list(), std::pair(Names({"m.obj", "a.mtl", "c.mtl"}), true));
  EXPECT_EQ(list(), std::pair(Names({"m.obj", "a.mtl", "c.mtl"}), false));
  // What was missing comes.
  folder_.write("b.mtl", "newmtl b\n");
  settle();
  EXPECT_EQ(list(), std::pair(Names({"m.obj", "a.mtl", "b.mtl", "c.mtl"}), true));
  EXPECT_EQ(list(), std::pair(Names({"m.obj", "a.mtl", "b.mtl", "c.mtl"}), false));
  // What was there goes.
  fs::remove(folder_.path() / "a.mtl");
  EXPECT_EQ(list(), std::pair(Names({"m.obj", "b.mtl", "c.mtl"}), true));
  EXPECT_EQ(list(), std::pair(Names({"m.obj", "b.mtl", "c.mtl"}), false));
  // The mesh changes.
  folder_.write("m.obj", "mtllib c.mtl\nv 0 0 0\n");
  EXPECT_EQ(list(), std::pair(Names({"m.obj", "c.mtl"}), true));
  EXPECT_EQ(list(), std::pair(Names({"m.obj", "c.mtl"}), true));  // not settled
  settle();
  EXPECT_EQ(list(), std::pair(Names({"m.obj", "c.mtl"}), true));
  EXPECT_EQ(list(), std::pair(Names({"m.obj", "c.mtl"}), false));
}

TEST_F(FilesOf, AreFoundAnewWhereNamesLeadElsewhere) {
  EXPECT_TRUE(list().second);
  EXPECT_FALSE(list().second);
  // "sub/.." is another folder behind a link.
  fs::create_directories(folder_.path() / "far/away");
  folder_.write("far/c.mtl", "newmtl other\n");
  fs::remove(folder_.path() / "sub");
  fs::create_directory_symlink("far/away", folder_.path() / "sub");
  EXPECT_EQ(list(), std::pair(Names({"m.obj", "a.mtl", "c.mtl"}), true));
}

TEST_F(FilesOf, AreFoundAnewIfALineIsDamaged) {
  const auto found = list().first;
  const std::string text = test::read_text(folder_.path() / "j");
  EXPECT_FALSE(list().second);
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string damaged = text;
    damaged[i] = static_cast<char>(damaged[i] ^ 1);
    folder_.write("j", damaged);
    EXPECT_EQ(list().first, found) << i;
  }
  for (const char* other : {"\"a.mtl", "b.mtl", "\"seal\":\""}) {
    std::string damaged = text;
    const std::size_t at = damaged.rfind(std::string(other).substr(other[0] == '"' ? 1 : 0, 5));
    ASSERT_NE(at, std::string::npos);
    damaged[at] = static_cast<char>(damaged[at] ^ 1);
    folder_.write("j", damaged);
    EXPECT_TRUE(list().second) << other;
  }
}

TEST_F(FilesOf, AreFoundAnewIfNotAllIsKnownThatDecides) {
  Journal journal = require(Journal::open(folder_.path() / "j"));
  const fs::path mesh = folder_.path() / "m.obj";
  std::size_t readings = 0;
  const auto find = [&]() -> Result<SourceFileList> {
    ++readings;
    SourceFileList found = require(find_source_files(mesh));
    found.is_all = false;
    return found;
  };
  EXPECT_TRUE(journal.files_of(mesh, find));
  EXPECT_TRUE(journal.files_of(mesh, find));
  EXPECT_EQ(readings, 2u);
  EXPECT_EQ(
      journal.files_of(mesh, [] { return Result<SourceFileList>(Errc::kImportFailed); }).code(),
      Errc::kImportFailed);
}

// Another change within the step of the file system's times would not show.
TEST(Journal, WhatHasJustChangedIsNotRemembered) {
  const test::TempFolder folder;
  const fs::path path = folder.path() / "j", file = folder.write("f", "bytes");
  Journal journal = require(Journal::open(path));
  EXPECT_EQ(require(journal.digest_of(file)), sha256_of("bytes"));
  EXPECT_EQ(test::read_text(path), "");
}

TEST(Journal, StatesThatAreNoneAreNotRemembered) {
  const test::TempFolder folder;
  const fs::path path = folder.path() / "j", file = folder.write("f", "bytes");
  const std::string digest = hex_of(sha256_of("remembered"));
  for (const char* state : {"[]", "[1,2,3,4]", "[1,2,3,4,5,6]", "[\"1\",2,3,4,5]", "[1.5,2,3,4,5]",
                            "{}", "[null,null,null,null,null]", "7"}) {
    folder.write("j", fmt::format(R"({{"file":"{}","state":{},"sha256":"{}"}})"
                                  "\n",
                                  file.string(), state, digest));
    EXPECT_EQ(require(require(Journal::open(path)).digest_of(file)), sha256_of("bytes")) << state;
  }
}

TEST(FileState, ChangesOfTheLastTwoSecondsAreNotSettled) {
  constexpr std::int64_t kNow = 1'700'000'000'000'000'000, kSecond = 1'000'000'000;
  const auto state = [](std::int64_t modified, std::int64_t changed) {
    return FileState{
        {1, 2, 3, static_cast<std::uint64_t>(modified), static_cast<std::uint64_t>(changed)}};
  };
  EXPECT_TRUE(state(kNow - 3 * kSecond, kNow - 3 * kSecond).is_settled(kNow));
  EXPECT_FALSE(state(kNow - 2 * kSecond, kNow - 3 * kSecond).is_settled(kNow));
  EXPECT_FALSE(state(kNow - 3 * kSecond, kNow - kSecond).is_settled(kNow));
  EXPECT_FALSE(state(kNow + 3 * kSecond, kNow - 3 * kSecond).is_settled(kNow));  // clocks differ
}

}  // namespace
}  // namespace boxtree::cooker
