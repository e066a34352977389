// SPDX-License-Identifier: MIT
// A journal can cost time and never a wrong output: each way in which it, or an output, is damaged.
#include "cooker/farm/journal.h"

#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/require.h"
#include "tests/support/temp_folder.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;
using test::require;

const Digest kKey = sha256_of("key");

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
    const Journal journal = require(Journal::open(path));
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

}  // namespace
}  // namespace boxtree::cooker
