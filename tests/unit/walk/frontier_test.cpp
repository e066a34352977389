// SPDX-License-Identifier: MIT
// The order in which waiting entries are taken, beside the same entries sorted.
#include "runtime/walk/frontier.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace boxtree {
namespace {

constexpr double kAll = std::numeric_limits<double>::infinity();

using Entries = Frontier<std::size_t, 64, 256>;

std::vector<double> random_keys(std::size_t count, std::uint32_t seed) {
  std::mt19937 generator(seed);
  std::uniform_int_distribution<int> number(0, 40);  // some are equal
  std::vector<double> keys(count);
  for (double& key : keys) key = number(generator);
  return keys;
}

TEST(Frontier, TakesTheLeastKeyFirstAndOfEqualOnesTheLast) {
  const std::vector<double> keys = random_keys(64, 1);
  Entries entries;
  for (std::size_t i = 0; i < keys.size(); ++i) ASSERT_TRUE(entries.push(keys[i], kAll, i));
  std::vector<std::size_t> expected(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) expected[i] = keys.size() - 1 - i;
  std::ranges::stable_sort(expected, {}, [&](std::size_t i) { return keys[i]; });
  for (const std::size_t i : expected) {
    EXPECT_EQ(entries.least_left(), keys[i]);
    double key = 0;
    std::size_t entry = 0;
    ASSERT_TRUE(entries.pop(kAll, key, entry));
    EXPECT_EQ(entry, i);
    EXPECT_EQ(key, keys[i]);
  }
  EXPECT_EQ(entries.least_left(), kAll);
}

// Also where most entries are on the stack, which comes first whatever its keys are.
TEST(Frontier, GoesByTheKeysOfNow) {
  for (const std::size_t count : {40u, 64u, 300u}) {
    SCOPED_TRACE(count);
    const std::vector<double> keys = random_keys(count, 2);
    const std::vector<double> growth = random_keys(count, 3);
    constexpr double kEnough = 50;
    Entries entries;
    for (std::size_t i = 0; i < count; ++i) ASSERT_TRUE(entries.push(keys[i], kAll, i));
    std::vector<double> expected;
    double least_left = kAll;
    for (std::size_t i = 0; i < count; ++i) {
      const double now = std::max(keys[i], growth[i] + 20);
      if (now < kEnough) {
        expected.push_back(now);
      } else {
        least_left = std::min(least_left, now);
      }
    }
    std::vector<double> taken;
    double key = 0;
    std::size_t entry = 0;
    while (entries.pop(kEnough, key, entry, [&](std::size_t i) { return growth[i] + 20; })) {
      EXPECT_EQ(key, std::max(keys[entry], growth[entry] + 20));
      taken.push_back(key);
    }
    EXPECT_EQ(entries.least_left(), least_left);
    EXPECT_TRUE(count > 64 || std::ranges::is_sorted(taken));
    std::ranges::sort(taken);
    std::ranges::sort(expected);
    EXPECT_EQ(taken, expected);
  }
}

}  // namespace
}  // namespace boxtree
