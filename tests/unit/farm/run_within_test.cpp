// SPDX-License-Identifier: MIT
// Tasks run once each, side by side, and never take more memory together than there is.
#include "cooker/farm/run_within.h"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

namespace boxtree::cooker {
namespace {

TEST(RunWithin, KeepsToTheMemory) {
  constexpr std::size_t kCount = 200;
  constexpr std::uint64_t kMemory = 100;
  const auto size_of = [](std::size_t task) { return std::uint64_t{10 + 7 * (task % 9)}; };
  std::atomic<std::uint64_t> taken = 0, most = 0;
  std::vector<std::atomic<int>> runs(kCount);
  tbb::task_arena arena(4);
  arena.execute([&] {
    run_within({kCount, kMemory, size_of,
                [&](std::size_t task) {
                  const std::uint64_t now = taken += size_of(task);
                  std::uint64_t before = most;
                  while (before < now && !most.compare_exchange_weak(before, now)) {
                  }
                  // Loops inside use the arena, and start no other task on this thread.
                  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, 50, 1),
                                    [](const auto&) { std::this_thread::yield(); });
                  ++runs[task];
                  taken -= size_of(task);
                },
                [] { return false; }});
  });
  for (const auto& count : runs) EXPECT_EQ(count, 1);
  EXPECT_LE(most, kMemory);
  EXPECT_EQ(taken, 0u);
}

TEST(RunWithin, WhatDoesNotFitAloneRunsAlone) {
  std::atomic<int> running = 0, together = 0, ran = 0;
  tbb::task_arena arena(4);
  arena.execute([&] {
    run_within({6, 10, [](std::size_t task) { return std::uint64_t{task % 2 == 0 ? 1000u : 1u}; },
                [&](std::size_t task) {
                  const int now = ++running;
                  if (task % 2 == 0 && now > 1) ++together;
                  std::this_thread::yield();
                  ++ran;
                  --running;
                },
                [] { return false; }});
  });
  EXPECT_EQ(ran, 6);
  EXPECT_EQ(together, 0);
}

TEST(RunWithin, StartsNoMoreWhenItIsStopped) {
  std::atomic<int> ran = 0;
  tbb::task_arena arena(1);
  arena.execute([&] {
    run_within({100, 10, [](std::size_t) { return std::uint64_t{1}; }, [&](std::size_t) { ++ran; },
                [&] { return ran >= 3; }});
  });
  EXPECT_EQ(ran, 3);
}

TEST(RunWithin, NothingIsDoneAtOnce) {
  run_within({0, 10, [](std::size_t) { return std::uint64_t{1}; }, [](std::size_t) { FAIL(); },
              [] { return false; }});
}

}  // namespace
}  // namespace boxtree::cooker
