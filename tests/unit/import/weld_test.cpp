// SPDX-License-Identifier: MIT
#include "cooker/import/weld.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <random>
#include <span>

#include <gtest/gtest.h>

namespace boxtree::cooker {
namespace {

TEST(Weld, EqualBitsGetOneNumber) {
  std::vector<float> positions;
  Welder<float> welder(positions);
  EXPECT_EQ(welder.add({1, 2, 3}), 0u);
  EXPECT_EQ(welder.add({3, 2, 1}), 1u);
  EXPECT_EQ(welder.add({1, 2, 3}), 0u);
  EXPECT_EQ(positions, (std::vector<float>{1, 2, 3, 3, 2, 1}));
}

TEST(Weld, SignedZerosAndNeighboursStayApart) {
  std::vector<float> positions;
  Welder<float> welder(positions);
  EXPECT_EQ(welder.add({0.0f, 1, 1}), 0u);
  EXPECT_EQ(welder.add({-0.0f, 1, 1}), 1u);
  EXPECT_EQ(welder.add({std::nextafter(0.0f, 1.0f), 1, 1}), 2u);
  EXPECT_TRUE(std::signbit(positions[3]));
}

TEST(Weld, DoublesDifferInTheLastBit) {
  std::vector<double> positions;
  Welder<double> welder(positions);
  EXPECT_EQ(welder.add({1, 1, 1}), 0u);
  EXPECT_EQ(welder.add({1, 1, std::nextafter(1.0, 2.0)}), 1u);
  EXPECT_EQ(welder.add({1, 1, 1}), 0u);
}

// Against std::map, through many growths of the table and with room requested on the way.
template <class T>
void expect_like_map(unsigned seed, int values) {
  std::mt19937 random(seed);
  std::vector<T> positions;
  Welder<T> welder(positions);
  std::map<std::array<T, 3>, std::uint32_t> expected;
  for (int i = 0; i < 50'000; ++i) {
    const auto value = [&] { return static_cast<T>(static_cast<int>(random() % 1000) % values); };
    const std::array<T, 3> position = {value(), value(), value()};
    const auto number = static_cast<std::uint32_t>(expected.size());
    const auto [entry, is_new] = expected.emplace(position, number);
    if (i % 9973 == 0) welder.reserve(static_cast<std::size_t>(i));
    ASSERT_EQ(welder.add(position), entry->second) << "seed " << seed << ", step " << i;
  }
  ASSERT_EQ(positions.size(), 3 * expected.size());
}

TEST(Weld, AgreesWithMap) {
  expect_like_map<float>(1, 10);
  expect_like_map<float>(2, 1000);
  expect_like_map<double>(3, 30);
}

// In place: the same as adding the used ones to an array of their own.
template <class T>
void expect_in_place(unsigned seed, int values, std::size_t expected_vertices) {
  std::mt19937 random(seed);
  std::vector<T> positions, expected;
  std::vector<std::uint32_t> numbers, expected_numbers;
  Welder<T> welder(expected);
  for (int i = 0; i < 20'000; ++i) {
    const auto value = [&] { return static_cast<T>(static_cast<int>(random() % 1000) % values); };
    const std::array<T, 3> position = {value(), value(), value()};
    positions.insert(positions.end(), position.begin(), position.end());
    const bool used = random() % 4 != 0;
    numbers.push_back(used ? kWeldUsed : kWeldUnused);
    expected_numbers.push_back(used ? welder.add(position) : kWeldUnused);
  }
  weld_in_place(positions, std::span(numbers), expected_vertices);
  EXPECT_EQ(numbers, expected_numbers);
  EXPECT_EQ(positions, expected);
}

TEST(Weld, InPlace) {
  expect_in_place<float>(4, 10, 0);
  expect_in_place<float>(5, 1000, 15'000);
  expect_in_place<double>(6, 30, 100);
}

// Regular grids have few distinct bits; a poor hash would take minutes here.
TEST(Weld, GridIsFast) {
  std::vector<float> positions;
  Welder<float> welder(positions);
  constexpr int kSide = 64;
  for (int round = 0; round < 2; ++round) {
    std::uint32_t number = 0;
    for (int i = 0; i < kSide * kSide * kSide; ++i) {
      const std::array<float, 3> position = {static_cast<float>(i % kSide),
                                             static_cast<float>(i / kSide % kSide) * 256,
                                             static_cast<float>(i / kSide / kSide) / 1024};
      ASSERT_EQ(welder.add(position), number++);
    }
  }
}

}  // namespace
}  // namespace boxtree::cooker
