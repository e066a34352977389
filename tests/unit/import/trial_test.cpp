// SPDX-License-Identifier: MIT
// Work in a copy of the process: its result comes back, its end does not hurt, its limits hold; and
// files that crash assimp's readers are errors.
#include "cooker/import/trial.h"

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

#include "cooker/import/import.h"
#include "tests/support/temp_folder.h"

namespace boxtree::cooker {
namespace {

using Value = Result<std::uint64_t>;

constexpr TrialLimits kLimits{10, 100, std::uint64_t{1} << 28};

TEST(Trial, WhatIsReturnedComesBackAndNothingElse) {
  int changed = 0;
  const Value result = try_in_child(kLimits, [&changed]() -> Value {
    ++changed;
    std::puts("printed by nobody");
    return 0x123456789abcdef0u;
  });
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(*result, 0x123456789abcdef0u);
  EXPECT_EQ(changed, 0);
  const Value status = try_in_child(kLimits, []() -> Value {
    return Error{Errc::kNoFaces, "no face: \xc3\xa9"};
  });
  EXPECT_EQ(status.code(), Errc::kNoFaces);
  EXPECT_EQ(status.error().detail, "no face: \xc3\xa9");
}

TEST(Trial, CrashesAndExitsAreErrors) {
  const Value crash = try_in_child(kLimits, []() -> Value {
    static_cast<void>(std::signal(SIGSEGV, SIG_DFL));
    static_cast<void>(std::raise(SIGSEGV));
    return 0;
  });
  EXPECT_EQ(crash.code(), Errc::kImportFailed);
  EXPECT_EQ(crash.error().detail, "assimp's reader crashed on it, by signal 11");
  const Value exit = try_in_child(kLimits, []() -> Value { std::_Exit(7); });
  EXPECT_EQ(exit.code(), Errc::kImportFailed);
  EXPECT_NE(exit.error().detail.find("status 7"), std::string::npos);
  const Value thrown = try_in_child(kLimits, []() -> Value { throw 3; });
  EXPECT_EQ(thrown.code(), Errc::kImportFailed);
}

TEST(Trial, WhatNeverEndsIsEnded) {
  const Value status = try_in_child({1, 100, kLimits.bytes}, []() -> Value {
    for (std::atomic<unsigned> turns = 0;;) ++turns;
  });
  EXPECT_EQ(status.code(), Errc::kImportFailed);
  EXPECT_NE(status.error().detail.find("it may take 1 s of processor time"), std::string::npos)
      << status.error().detail;
}

TEST(Trial, WhatIsStoppedIsEndedByTheClock) {
  for (const int signal : {SIGSTOP, 0}) {
    const Value status = try_in_child({10, 2, kLimits.bytes}, [signal]() -> Value {
      if (signal != 0) static_cast<void>(std::raise(signal));
      for (;;) ::pause();
    });
    EXPECT_EQ(status.code(), Errc::kImportFailed);
    EXPECT_EQ(
        status.error().detail.find("assimp's reader was ended, since it did not end by itself: "
                                   "it may take 10 s of processor time, 2 s by the clock"),
        0u)
        << status.error().detail;
  }
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "a copy is left";
}

TEST(Trial, WhatClosesItsEndIsNotWaitedFor) {
  const Value status = try_in_child({10, 100, kLimits.bytes}, []() -> Value {
    for (int file = 3; file < 64; ++file) ::close(file);
    for (;;) ::pause();
  });
  EXPECT_EQ(status.code(), Errc::kImportFailed);
}

TEST(Trial, MemoryHasALimit) {
  if (!kLimitsMemory) GTEST_SKIP() << "the address space of sanitizers cannot be limited";
  const auto take = [](std::size_t bytes) {
    return [bytes] {
      const std::vector<char> much(bytes, 'x');
      return much[bytes / 2] == 'x' ? Value(1) : Value(Error{Errc::kInternal, ""});
    };
  };
  EXPECT_TRUE(try_in_child(kLimits, take(kLimits.bytes / 2)).ok());
  EXPECT_EQ(try_in_child(kLimits, take(2 * kLimits.bytes)).code(), Errc::kOutOfMemory);
}

// Objects below each other, deeper than the stack of the reader that goes down by recursion.
TEST(Trial, AFileThatCrashesAssimpIsAnError) {
  const test::TempFolder folder;
  std::string text = "AC3Db\n";
  for (int i = 0; i < 400000; ++i) text += "OBJECT group\nkids 1\n";
  const auto path = folder.write("deep.ac", text + "OBJECT group\nkids 0\n");
  const Result<Imported> imported = import_mesh(path, {.try_first = true});
  ASSERT_EQ(imported.code(), Errc::kImportFailed);
  // Sanitizers turn a crash into an exit.
  const char* const how = kLimitsMemory ? "crashed on it" : "ended the process";
  EXPECT_NE(imported.error().detail.find(path.string() + ": assimp's reader " + how),
            std::string::npos)
      << imported.error().detail;
}

TEST(Trial, WhatIsReadInTheEndIsTheSame) {
  const test::TempFolder folder;
  const auto path = folder.write("square.ac",
                                 "AC3Db\nMATERIAL \"\" rgb 1 1 1 amb 1 1 1 emis 0 0 0 spec 0 0 0 "
                                 "shi 0 trans 0\nOBJECT world\nkids 1\nOBJECT poly\nnumvert 4\n"
                                 "0 0 0\n1 0 0\n1 1 0\n0 1 0\nnumsurf 1\nSURF 0x20\nmat 0\n"
                                 "refs 4\n0 0 0\n1 0 0\n2 0 0\n3 0 0\nkids 0\n");
  const Result<Imported> once = import_mesh(path);
  const Result<Imported> tried = import_mesh(path, {.try_first = true});
  ASSERT_TRUE(once.ok()) << once.error().detail;
  ASSERT_TRUE(tried.ok()) << tried.error().detail;
  EXPECT_EQ(tried->mesh.positions.f32, once->mesh.positions.f32);
  EXPECT_EQ(tried->mesh.faces.size(), 1u);
  EXPECT_EQ(tried->report.content_hash, once->report.content_hash);
  EXPECT_EQ(tried->report.files_read, once->report.files_read);
  const auto cut = folder.write("cut.ac", "AC3Db\nOBJECT");
  EXPECT_EQ(import_mesh(cut, {.try_first = true}).error().detail, import_mesh(cut).error().detail);
}

}  // namespace
}  // namespace boxtree::cooker
