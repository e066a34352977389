// SPDX-License-Identifier: MIT
// A cache on a server gives the bytes that were stored, or nothing, whatever the server does
// (tests/farm/faulty_server.py).
#include "cooker/farm/http_cache.h"

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

#include "cooker/farm/http_client.h"
#include "tests/support/require.h"
#include "tests/support/temp_folder.h"
#include "tests/unit/farm/cache_values.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;
using test::require;

using test::kKey;
const std::string kOutput(100000, 'o');
constexpr const char* kReport = "[\"a report\"]";
// Of tests that wait for a server which does not answer.
constexpr HttpLimits kShort{500, 1, 1 << 20};

class Server {
 public:
  Server() {
    std::array<int, 2> in{}, out{};
    if (::pipe(in.data()) != 0 || ::pipe(out.data()) != 0) throw std::runtime_error("pipe");
    process_ = ::fork();
    if (process_ == 0) {
      ::dup2(in[0], 0);
      ::dup2(out[1], 1);
      for (const int each : {in[0], in[1], out[0], out[1]}) ::close(each);
      ::execlp("python3", "python3", BOXTREE_FAULTY_SERVER, nullptr);
      ::_exit(127);
    }
    ::close(in[0]);
    ::close(out[1]);
    to_ = in[1];
    std::array<char, 16> port{};
    std::size_t got = 0;
    while (got < port.size() && ::read(out[0], &port[got], 1) == 1 && port[got] != '\n') ++got;
    ::close(out[0]);
    port_.assign(port.data(), got);
  }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;
  ~Server() {
    ::close(to_);
    ::waitpid(process_, nullptr, 0);
  }

  [[nodiscard]] bool is_there() const { return !port_.empty(); }
  [[nodiscard]] std::string url(const std::string& fault) const {
    return "http://127.0.0.1:" + port_ + "/" + fault;
  }
  [[nodiscard]] int requests(const std::string& fault) const {
    std::string count;
    const HttpClient client = require(HttpClient::open({}));
    const int status = require(client.get(url("count/" + fault), [&](std::string_view bytes) {
      count += bytes;
      return true;
    }));
    return status == 200 ? std::stoi(count) : -1;
  }

 private:
  pid_t process_ = -1;
  int to_ = -1;
  std::string port_;
};

class HttpCacheTest : public testing::Test {
 protected:
  void SetUp() override {
    if (HttpClient::open({}).code() == Errc::kFeatureUnsupported) GTEST_SKIP() << "no libcurl";
    ASSERT_TRUE(server_.is_there()) << "python3 does not run " << BOXTREE_FAULTY_SERVER;
  }

  [[nodiscard]] HttpCache cache(const std::string& fault, const HttpLimits& limits = {}) const {
    return require(HttpCache::open(server_.url(fault), limits));
  }

  Result<CookCache::Entry> store(const HttpCache& cache, const Digest& key = kKey,
                                 const std::string& bytes = kOutput) const {
    return cache.store(key, folder_.write("stored", bytes), kReport);
  }

  // What the cache has under a key, or "none".
  [[nodiscard]] std::string fetched(const HttpCache& cache, const Digest& key = kKey) const {
    static std::atomic<int> count = 0;
    const fs::path output = folder_.path() / ("fetched" + std::to_string(count++));
    const auto entry = require(cache.fetch(key, output));
    if (!entry) {
      EXPECT_FALSE(fs::exists(output));
      return "none";
    }
    EXPECT_EQ(entry->report, kReport);
    EXPECT_EQ(entry->bytes, fs::file_size(output));
    return test::read_text(output);
  }

  // One warning, with that text; none if it is empty.
  static void expect_warning(const HttpCache& cache, const std::string& text) {
    const std::vector<std::string> warnings = cache.take_warnings();
    ASSERT_EQ(warnings.size(), text.empty() ? 0u : 1u);
    if (text.empty()) return;
    EXPECT_NE(warnings[0].find(text), std::string::npos) << warnings[0];
  }

  const Server server_;
  const test::TempFolder folder_;
};

TEST_F(HttpCacheTest, GivesBackWhatWasStored) {
  const HttpCache good = cache("good");
  EXPECT_EQ(fetched(good), "none");
  const CookCache::Entry stored = require(store(good));
  EXPECT_EQ(stored.output, sha256_of(kOutput));
  EXPECT_EQ(stored.bytes, kOutput.size());
  EXPECT_EQ(fetched(good), kOutput);
  EXPECT_EQ(fetched(cache("good")), kOutput);
  EXPECT_EQ(fetched(cache("good/")), kOutput);
  EXPECT_EQ(fetched(good, sha256_of("other")), "none");
  ASSERT_TRUE(store(good, kKey, "newer"));
  EXPECT_EQ(fetched(good), "newer");
  ASSERT_TRUE(store(good, kKey, ""));
  EXPECT_EQ(fetched(good), "");
  const std::string large(5 << 20, 'l');  // more than fits into what systems buffer
  ASSERT_TRUE(store(good, kKey, large));
  EXPECT_EQ(fetched(good), large);
  expect_warning(good, "");
}

TEST_F(HttpCacheTest, AnOutputThatIsThereIsNotSent) {
  const HttpCache good = cache("good");
  ASSERT_TRUE(store(good));
  const fs::path output = folder_.write("there", kOutput);
  const int before = server_.requests("good");
  const auto entry = require(good.fetch(kKey, output));
  ASSERT_TRUE(entry);
  EXPECT_EQ(entry->report, kReport);
  EXPECT_EQ(server_.requests("good"), before + 1);
}

// Whatever is wrong with an answer, nothing is written, and the warning says what was found.
TEST_F(HttpCacheTest, EveryFaultOfAnAnswerIsAMiss) {
  ASSERT_TRUE(store(cache("good")));
  ASSERT_TRUE(store(cache("good"), sha256_of("other"), "another output"));
  struct Case {
    const char* fault;
    const char* warning;
  };
  for (const Case& each : {
           Case{"html", "expected an entry of boxtree"},
           Case{"ac-html", "expected an entry of boxtree"},
           Case{"cas-html", "expected 100000 bytes, found "},
           Case{"redirect", "found 302"},
           Case{"cas-redirect", "found 302"},
           Case{"301", "found 301"},
           Case{"403", "found 403"},
           Case{"500", "found 500"},
           Case{"cas-500", "found 500"},
           Case{"206", "found 206"},
           Case{"404", ""},
           Case{"cas-404", ""},
           Case{"ac-empty", "expected an entry of boxtree"},
           Case{"cas-empty", "expected 100000 bytes, found 0"},
           Case{"ac-short", "/ac/"},
           Case{"cas-short", "/cas/"},
           Case{"ac-half", "expected an entry of boxtree"},
           Case{"cas-half", "expected 100000 bytes, found 50000"},
           Case{"ac-long", "expected an entry of boxtree"},
           Case{"cas-long", "expected the 100000 bytes of its entry, found more"},
           Case{"ac-wrong", "expected an entry of boxtree"},
           Case{"cas-wrong", "another SHA-256"},
           Case{"ac-other", "expected an entry of boxtree"},
           Case{"cas-other", "expected 100000 bytes, found 14"},
           Case{"ac-endless", "of at most 4194304 bytes, found more"},
           Case{"cas-endless", "found more"},
           Case{"closes", "/ac/"},
           Case{"cas-closes", "/cas/"},
           Case{"garbage", "/ac/"},
           Case{"cas-garbage", "/cas/"},
       }) {
    SCOPED_TRACE(each.fault);
    const HttpCache faulty = cache(each.fault);
    EXPECT_EQ(fetched(faulty), "none");
    expect_warning(faulty, each.warning);
    EXPECT_EQ(fetched(faulty), "none");
    expect_warning(faulty, "");
  }
  EXPECT_EQ(fetched(cache("good")), kOutput);
}

TEST_F(HttpCacheTest, ASlowServerIsNotWaitedFor) {
  ASSERT_TRUE(store(cache("good")));
  for (const char* fault : {"slow", "cas-slow", "drip", "cas-drip"}) {
    SCOPED_TRACE(fault);
    const HttpCache faulty = cache(fault, kShort);
    EXPECT_EQ(fetched(faulty), "none");
    EXPECT_EQ(faulty.take_warnings().size(), 1u);
  }
  const HttpCache slow = cache("slow", kShort);
  EXPECT_EQ(store(slow).code(), Errc::kWriteFailed);
}

TEST_F(HttpCacheTest, WhatIsNotTakenIsNotThere) {
  for (const char* fault : {"507", "413", "early413", "500", "403", "302", "closes"}) {
    SCOPED_TRACE(fault);
    const HttpCache faulty = cache(fault);
    const std::string large(5 << 20, 'l');
    EXPECT_EQ(store(faulty, kKey, large).code(), Errc::kWriteFailed);
    EXPECT_EQ(faulty.take_warnings().size(), 1u);
    EXPECT_EQ(fetched(cache("good")), "none");
  }
  // What is taken and lost, or half of it, is a miss later.
  for (const char* fault : {"half", "loses"}) {
    ASSERT_TRUE(store(cache(fault)));
    EXPECT_EQ(fetched(cache("good")), "none");
    ASSERT_TRUE(store(cache("good")));
    EXPECT_EQ(fetched(cache("good")), kOutput);
  }
}

TEST_F(HttpCacheTest, AServerThatFailsAgainAndAgainIsLeftAlone) {
  const HttpCache faulty = cache("500");
  for (int i = 0; i < 10; ++i) EXPECT_EQ(fetched(faulty), "none");
  EXPECT_EQ(server_.requests("500"), HttpCache::kMostFailures);
  std::vector<std::string> warnings = faulty.take_warnings();
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_NE(warnings[0].find("found 500"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[1].find("3 failures in a row"), std::string::npos) << warnings[1];
  EXPECT_NE(warnings[1].find("nothing more is looked for there in this run"), std::string::npos);
  // It answers, so that it may take what comes; when it does not, that ends, too.
  for (int i = 0; i < 10; ++i) static_cast<void>(store(faulty));
  EXPECT_EQ(server_.requests("500"), 2 * HttpCache::kMostFailures);
  warnings = faulty.take_warnings();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("nothing more is sent there in this run"), std::string::npos);
}

// A server that is full, and one that has nothing, go on being read.
TEST_F(HttpCacheTest, FailuresThatAreNotInARowAreBorne) {
  ASSERT_TRUE(store(cache("good")));
  const HttpCache full = cache("507");
  for (int i = 0; i < 10; ++i) {
    static_cast<void>(store(full));
    EXPECT_EQ(fetched(full), kOutput);
  }
  EXPECT_EQ(full.take_warnings().size(), 2u);
  EXPECT_EQ(server_.requests("507"), HttpCache::kMostFailures + 2 * 10);
  const HttpCache half = cache("cas-wrong");
  for (int i = 0; i < 10; ++i) {  // its entries are right
    EXPECT_EQ(fetched(half, sha256_of("none such")), "none");
    EXPECT_EQ(fetched(half), "none");
  }
  EXPECT_EQ(half.take_warnings().size(), 1u);
}

TEST_F(HttpCacheTest, WhereNobodyListensNothingIsSentEither) {
  std::string gone;
  {
    const Server ended;
    gone = ended.url("good");
  }
  const HttpCache away = require(HttpCache::open(gone));
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(fetched(away), "none");
    static_cast<void>(store(away));
  }
  const std::vector<std::string> warnings = away.take_warnings();
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_NE(warnings[1].find("nothing more is looked for or sent there"), std::string::npos);
}

// No message has the password, and the server gets it.
TEST_F(HttpCacheTest, APasswordIsNotTold) {
  std::string url = server_.url("500");
  url.replace(0, 7, "http://someone:secret@");
  const HttpCache faulty = require(HttpCache::open(url));
  for (int i = 0; i < 4; ++i) EXPECT_EQ(fetched(faulty), "none");
  for (const std::string& warning : faulty.take_warnings()) {
    EXPECT_EQ(warning.find("secret"), std::string::npos) << warning;
    EXPECT_NE(warning.find(server_.url("500")), std::string::npos) << warning;
  }
}

TEST_F(HttpCacheTest, UrlsThatAreNoneAreRefused) {
  for (const char* url : {"", "http:", "ftp://host", "file:///tmp", "http://", "http:///x",
                          "http://:80/x", "http://user@/x", "http://a b/", "http://host/?q",
                          "http://host/#f", "http://h\n/", "HTTP://host"}) {
    EXPECT_EQ(HttpCache::open(url).code(), Errc::kDocumentInvalid) << url;
  }
}

TEST_F(HttpCacheTest, TheOutputThatCannotBeWrittenIsAnError) {
  const HttpCache good = cache("good");
  ASSERT_TRUE(store(good));
  EXPECT_EQ(good.fetch(kKey, folder_.path() / "absent" / "o").code(), Errc::kWriteFailed);
  EXPECT_EQ(good.store(kKey, folder_.path() / "absent", "").code(), Errc::kFileNotFound);
}

TEST_F(HttpCacheTest, IsSafeForManyThreads) {
  const HttpCache good = cache("good");
  std::vector<std::thread> threads;
  std::atomic<int> wrong = 0;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < 40; ++i) {
        const std::string name = std::to_string((i * 7 + t) % 10);
        const std::string bytes(20000, name[0]);
        const fs::path output = folder_.path() / (std::to_string(t) + ".got");
        fs::remove(output);
        const auto entry = require(good.fetch(sha256_of(name), output));
        if (entry && test::read_text(output) != bytes) ++wrong;
        if (entry) continue;
        const fs::path file = folder_.write(std::to_string(t) + ".put", bytes);
        if (!good.store(sha256_of(name), file, "[]")) ++wrong;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
  expect_warning(good, "");
}

TEST(CookCache, UrlsAndFolders) {
  for (const char* url : {"http://host", "https://host/x", "ftp://host"}) EXPECT_TRUE(is_url(url));
  for (const char* folder : {"", "cache", "/http://", "a/b://c", "://", "http:/host", "C:\\x"}) {
    EXPECT_FALSE(is_url(folder)) << folder;
  }
}

}  // namespace
}  // namespace boxtree::cooker
