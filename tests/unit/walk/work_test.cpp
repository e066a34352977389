// SPDX-License-Identifier: MIT
// The guard of every walk: nodes are counted once, bounds end, and the code says which one did.
#include "runtime/walk/work.h"

#include <atomic>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace boxtree {
namespace {

constexpr NodeState kValid = NodeState::kValid;
constexpr NodeState kCorrupt = NodeState::kCorrupt;

TEST(WalkBound, AllowsAsManyNodesAsAnHonestWalkMeets) {
  WalkBound nodes(2);
  EXPECT_EQ(nodes.count(kValid), Errc::kOk);
  EXPECT_EQ(nodes.count(kValid), Errc::kOk);
  EXPECT_EQ(nodes.count(kValid), Errc::kNodeCorrupt);
  EXPECT_EQ(nodes.count(kValid), Errc::kNodeCorrupt);
  EXPECT_EQ(WalkBound(0).count(kValid), Errc::kNodeCorrupt);
}

TEST(WalkBound, ACorruptNodeIsNotCounted) {
  QueryWork work(QueryLimits{10});
  {
    WalkBound nodes(2, &work);
    EXPECT_EQ(nodes.count(kCorrupt), Errc::kNodeCorrupt);
    EXPECT_EQ(nodes.count(kValid), Errc::kOk);
  }
  EXPECT_EQ(work.left, 9u);
}

// What is spent in one walk of a query is not there for the next.
TEST(WalkBound, ALimitIsSharedAndToldAsOne) {
  QueryWork work(QueryLimits{3});
  {
    WalkBound first(2, &work);
    EXPECT_EQ(first.count(kValid), Errc::kOk);
    EXPECT_EQ(first.count(kValid), Errc::kOk);
    EXPECT_EQ(first.count(kValid), Errc::kNodeCorrupt);  // the tree's own bound
  }
  EXPECT_EQ(work.left, 1u);
  {
    WalkBound second(5, &work);
    EXPECT_EQ(second.count(kValid), Errc::kOk);
    EXPECT_EQ(second.count(kValid), Errc::kWorkLimit);
    EXPECT_EQ(second.count(kCorrupt), Errc::kWorkLimit);
  }
  EXPECT_EQ(work.left, 0u);
  EXPECT_EQ(WalkBound(5, &work).count(kValid), Errc::kWorkLimit);
}

TEST(SharedWalkBound, CountsOnceForAllThreads) {
  constexpr std::uint32_t kMost = 10'000;
  SharedWalkBound nodes(kMost);
  std::atomic<std::uint32_t> counted = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] {
      for (std::uint32_t n = 0; n < kMost; ++n) counted += nodes.count(kValid) == Errc::kOk ? 1 : 0;
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(counted, kMost);
  EXPECT_EQ(nodes.count(kValid), Errc::kNodeCorrupt);
  EXPECT_EQ(SharedWalkBound(1).count(kCorrupt), Errc::kNodeCorrupt);
}

TEST(WalkStack, IsAsDeepAsAnHonestTreeAndNoDeeper) {
  WalkStack<int, 2> stack;
  EXPECT_TRUE(stack.empty());
  EXPECT_EQ(stack.push(1), Errc::kOk);
  EXPECT_EQ(stack.push(2), Errc::kOk);
  EXPECT_EQ(stack.push(3), Errc::kDepthExceeded);
  EXPECT_EQ(stack.pop(), 2);
  EXPECT_EQ(stack.pop(), 1);
  EXPECT_TRUE(stack.empty());
}

}  // namespace
}  // namespace boxtree
