// SPDX-License-Identifier: MIT
// A cache gives the bytes that were stored, or nothing: every way of damage, many threads and
// processes at once, and the size.
#include "cooker/farm/folder_cache.h"

#include <atomic>
#include <chrono>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/require.h"
#include "tests/support/temp_folder.h"
#include "tests/unit/farm/cache_values.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;
using test::require;

using test::kKey;
using test::kRoom;

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  return files;
}

std::uint64_t bytes_in(const fs::path& folder) {
  std::uint64_t bytes = 0;
  for (const char* kind : {"ac", "cas"}) {
    for (const fs::path& file : files_in(folder / kind)) bytes += fs::file_size(file);
  }
  return bytes;
}

// What the cache has under a key, or "none".
std::string fetched(const CookCache& cache, const Digest& key, const test::TempFolder& folder) {
  static std::atomic<int> count = 0;
  const fs::path output =
      folder.path() / ("fetched" + std::to_string(::getpid()) + "-" + std::to_string(count++));
  const auto entry = require(cache.fetch(key, output));
  if (!entry) {
    EXPECT_FALSE(fs::exists(output));
    return "none";
  }
  EXPECT_EQ(entry->bytes, fs::file_size(output));
  std::string bytes = test::read_text(output);
  fs::remove(output);
  return bytes;
}

TEST(FolderCache, GivesBackWhatWasStored) {
  const test::TempFolder folder;
  const FolderCache cache = require(FolderCache::open(folder.path() / "c", kRoom));
  EXPECT_EQ(fetched(cache, kKey, folder), "none");
  const auto stored = require(cache.store(kKey, folder.write("o", "bytes"), "[\"a report\"]"));
  EXPECT_EQ(stored.output, sha256_of("bytes"));
  EXPECT_EQ(fetched(cache, kKey, folder), "bytes");
  const auto entry = require(cache.fetch(kKey, folder.path() / "again"));
  ASSERT_TRUE(entry);
  EXPECT_EQ(entry->report, "[\"a report\"]");
  EXPECT_EQ(fetched(cache, sha256_of("other"), folder), "none");
  // Another process, later.
  EXPECT_EQ(fetched(require(FolderCache::open(folder.path() / "c", kRoom)), kKey, folder), "bytes");
  ASSERT_TRUE(cache.store(kKey, folder.write("o", "newer"), ""));
  EXPECT_EQ(fetched(cache, kKey, folder), "newer");
}

TEST(FolderCache, LeavesAnOutputAloneThatHasTheBytesAlready) {
  const test::TempFolder folder;
  const FolderCache cache = require(FolderCache::open(folder.path() / "c", kRoom));
  const fs::path output = folder.write("o", "bytes");
  ASSERT_TRUE(cache.store(kKey, output, ""));
  const auto before = fs::file_time_type::clock::now() - std::chrono::hours(1);
  fs::last_write_time(output, before);
  EXPECT_TRUE(require(cache.fetch(kKey, output)));
  EXPECT_EQ(fs::last_write_time(output), before);
  folder.write("o", "bytez");
  EXPECT_TRUE(require(cache.fetch(kKey, output)));
  EXPECT_EQ(test::read_text(output), "bytes");
}

// Each byte of each file of the cache changed, and each file cut short everywhere, longer, empty,
// and away.
TEST(FolderCache, DamageIsAMissAndIsReplaced) {
  const test::TempFolder folder;
  const FolderCache cache = require(FolderCache::open(folder.path() / "c", kRoom));
  const fs::path output = folder.write("o", "some bytes of a cooked file");
  ASSERT_TRUE(cache.store(kKey, output, "[]"));
  const std::string good = test::read_text(output);
  for (const char* kind : {"ac", "cas"}) {
    const std::vector<fs::path> files = files_in(folder.path() / "c" / kind);
    ASSERT_EQ(files.size(), 1u);
    const std::string name = fs::relative(files[0], folder.path()).string();
    const std::string whole = test::read_text(files[0]);
    std::vector<std::string> damaged = {"", whole + "x", whole + whole};
    for (std::size_t i = 0; i < whole.size(); ++i) {
      damaged.push_back(whole.substr(0, i));
      damaged.push_back(whole);
      damaged.back()[i] = static_cast<char>(damaged.back()[i] ^ 4);
    }
    for (const std::string& bytes : damaged) {
      folder.write(name, bytes);
      EXPECT_EQ(fetched(cache, kKey, folder), "none") << kind << bytes.size();
    }
    // Found by a newcomer: who damaged an entry was told nothing. The first is told; one that is
    // away is no damage.
    const FolderCache later = require(FolderCache::open(folder.path() / "c", kRoom));
    EXPECT_EQ(fetched(later, kKey, folder), "none");
    EXPECT_EQ(fetched(later, kKey, folder), "none");
    const std::vector<std::string> warnings = later.take_warnings();
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_TRUE(warnings[0].starts_with(files[0].string() + ": damaged in the cache: expected "))
        << warnings[0];
    fs::remove(files[0]);
    const FolderCache without = require(FolderCache::open(folder.path() / "c", kRoom));
    EXPECT_EQ(fetched(without, kKey, folder), "none");
    EXPECT_TRUE(without.take_warnings().empty());
    ASSERT_TRUE(cache.store(kKey, output, "[]"));
    EXPECT_EQ(fetched(cache, kKey, folder), good);
    folder.write(name, "damaged");
    ASSERT_TRUE(cache.store(kKey, output, "[]"));
    EXPECT_EQ(fetched(cache, kKey, folder), good);
  }
}

// A valid entry that somebody put under another key.
TEST(FolderCache, AnEntryOfAnotherKeyIsNone) {
  const test::TempFolder folder;
  const FolderCache cache = require(FolderCache::open(folder.path() / "c", kRoom));
  ASSERT_TRUE(cache.store(kKey, folder.write("o", "bytes"), ""));
  const Digest other = sha256_of("other");
  const fs::path from = files_in(folder.path() / "c" / "ac").front();
  folder.write("c/ac/" + hex_of(other).substr(0, 2) + "/" + hex_of(other), test::read_text(from));
  EXPECT_EQ(fetched(cache, other, folder), "none");
}

TEST(FolderCache, KeepsToItsSizeAndTheLeastRecentlyUsedGoFirst) {
  const test::TempFolder folder;
  constexpr std::uint64_t kMost = 40000;
  const FolderCache cache = require(FolderCache::open(folder.path() / "c", kMost));
  const auto key_of = [](int i) { return sha256_of("key" + std::to_string(i)); };
  const auto bytes_of = [](int i) { return std::string(1500, 'x') + std::to_string(i); };
  const auto start = fs::file_time_type::clock::now() - std::chrono::hours(24);
  // Found by a newcomer: files that somebody else has put there went first.
  fs::create_directories(folder.path() / "c/cas/aa");
  const fs::path foreign = folder.write("c/cas/aa/notes.txt", "");
  fs::last_write_time(foreign, start - std::chrono::hours(1));
  for (int i = 0; i < 60; ++i) {
    ASSERT_TRUE(cache.store(key_of(i), folder.write("o", bytes_of(i)), ""));
    EXPECT_LE(bytes_in(folder.path() / "c"), kMost);
    // Times as if a minute went by after each; those of the first one are new, since it is used.
    for (const fs::path& file : files_in(folder.path() / "c")) {
      const bool is_new = fs::last_write_time(file) > start + std::chrono::hours(12);
      if (is_new && file.filename() != "size") {
        fs::last_write_time(file, start + std::chrono::minutes(i));
      }
    }
    EXPECT_EQ(fetched(cache, key_of(0), folder), bytes_of(0)) << i;
    EXPECT_EQ(fetched(cache, key_of(i), folder), bytes_of(i));
  }
  EXPECT_EQ(fetched(cache, key_of(1), folder), "none");
  EXPECT_GT(bytes_in(folder.path() / "c"), kMost / 2);
  EXPECT_TRUE(fs::exists(foreign));
}

TEST(FolderCache, ADamagedCountIsCountedAnew) {
  const test::TempFolder folder;
  constexpr std::uint64_t kMost = 40000;
  const FolderCache cache = require(FolderCache::open(folder.path() / "c", kMost));
  for (const char* count : {"", "x", "12", "99999999999999999999999\n", "-5\n"}) {
    for (int i = 0; i < 30; ++i) {
      folder.write("c/size", count);
      const std::string name = count + std::to_string(i);
      ASSERT_TRUE(
          cache.store(sha256_of(name), folder.write("o", std::string(2000, 'x') + name), ""));
    }
    EXPECT_LE(bytes_in(folder.path() / "c"), kMost) << count;
  }
}

TEST(FolderCache, SaysWhereItCannotBe) {
  const test::TempFolder folder;
  folder.write("file", "");
  EXPECT_EQ(FolderCache::open(folder.path() / "file" / "c", kRoom).code(), Errc::kWriteFailed);
  const FolderCache cache = require(FolderCache::open(folder.path() / "c", kRoom));
  EXPECT_EQ(cache.store(kKey, folder.path() / "absent", "").code(), Errc::kFileNotFound);
  ASSERT_TRUE(cache.store(kKey, folder.write("o", "bytes"), ""));
  EXPECT_EQ(cache.fetch(kKey, folder.path() / "absent" / "o").code(), Errc::kWriteFailed);
  fs::remove_all(folder.path() / "c" / "cas");
  EXPECT_EQ(cache.store(kKey, folder.path() / "o", "").code(), Errc::kWriteFailed);
}

// Processes and threads that store, fetch and remove the same few keys at once: each fetch gives
// what the key stands for, or nothing.
TEST(FolderCache, IsSafeForManyAtOnce) {
  const test::TempFolder folder;
  constexpr std::uint64_t kMost = 12000;  // a few entries, so that they are removed all the time
  const auto work = [&](int seed) {
    const FolderCache cache = require(FolderCache::open(folder.path() / "c", kMost));
    for (int i = 0; i < 150; ++i) {
      const std::string name = std::to_string((i * 7 + seed) % 10);
      const std::string bytes = std::string(2000, name[0]);
      const std::string got = fetched(cache, sha256_of(name), folder);
      if (got != "none" && got != bytes) return false;
      const std::string file = std::to_string(::getpid()) + "-" + std::to_string(seed);
      if (got == "none" && !cache.store(sha256_of(name), folder.write(file, bytes), "[]"))
        return false;
    }
    return true;
  };
  std::vector<pid_t> children;
  for (int child = 0; child < 3; ++child) {
    const pid_t pid = ::fork();
    if (pid == 0) ::_exit(work(child) ? 0 : 1);
    children.push_back(pid);
  }
  std::vector<std::thread> threads;
  std::atomic<int> failed = 0;
  for (int t = 0; t < 2; ++t) threads.emplace_back([&, t] { failed += work(10 + t) ? 0 : 1; });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(failed, 0);
  for (const pid_t pid : children) {
    int how = 0;
    ASSERT_EQ(::waitpid(pid, &how, 0), pid);
    EXPECT_TRUE(WIFEXITED(how) && WEXITSTATUS(how) == 0) << how;
  }
  EXPECT_LE(bytes_in(folder.path() / "c"), kMost + 4000);
  for (const fs::path& file : files_in(folder.path() / "c")) {
    EXPECT_EQ(file.filename().string().find("cooking"), std::string::npos) << file;
  }
}

}  // namespace
}  // namespace boxtree::cooker
