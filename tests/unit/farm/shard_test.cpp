// SPDX-License-Identifier: MIT
// Every job is in one shard, by its digest alone, and shards are about equal.
#include "cooker/farm/shard.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace boxtree::cooker {
namespace {

TEST(Shard, IsTheDigestsFirstBytesModuloTheCount) {
  Digest digest{};
  digest[7] = std::byte{10};
  EXPECT_EQ(shard_of(digest, 1), 0u);
  EXPECT_EQ(shard_of(digest, 7), 3u);
  digest[6] = std::byte{1};  // 266
  EXPECT_EQ(shard_of(digest, 7), 0u);
  digest[8] = std::byte{99};
  EXPECT_EQ(shard_of(digest, 7), 0u);
}

TEST(Shard, DealsJobsOutEvenly) {
  constexpr std::uint32_t kCount = 8;
  std::vector<int> jobs(kCount);
  for (int i = 0; i < 8000; ++i) ++jobs[shard_of(sha256_of(std::to_string(i)), kCount)];
  for (const int of_one : jobs) EXPECT_NEAR(of_one, 1000, 150);
}

}  // namespace
}  // namespace boxtree::cooker
