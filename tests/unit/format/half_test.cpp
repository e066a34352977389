// SPDX-License-Identifier: MIT
// f16 by bit operations against the definition of binary16, over every pattern.
#include "format/half.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace boxtree {
namespace {

// The value by the definition of IEEE 754, in double.
double by_definition(std::uint16_t half) {
  const int exponent = (half >> 10) & 0x1f;
  const int mantissa = half & 0x3ff;
  const double sign = (half & 0x8000) != 0 ? -1 : 1;
  if (exponent == 0) return sign * std::ldexp(mantissa, -24);
  return sign * std::ldexp(1024 + mantissa, exponent - 25);
}

TEST(Half, EveryFinitePatternHasItsValue) {
  for (std::uint32_t bits = 0; bits < 0x10000; ++bits) {
    if ((bits & 0x7c00) == 0x7c00) continue;
    const auto half = static_cast<std::uint16_t>(bits);
    ASSERT_EQ(double{half_to_float(half)}, by_definition(half)) << bits;
  }
}

TEST(Half, InfinityAndNanStayWhatTheyAre) {
  EXPECT_EQ(half_to_float(0x7c00), std::numeric_limits<float>::infinity());
  EXPECT_EQ(half_to_float(0xfc00), -std::numeric_limits<float>::infinity());
  EXPECT_TRUE(std::isnan(half_to_float(0x7c01)));
}

TEST(Half, EveryValueRoundsToItself) {
  for (std::uint32_t bits = 0; bits < 0x7c00; ++bits) {
    const auto half = static_cast<std::uint16_t>(bits);
    ASSERT_EQ(half_toward_zero(half_to_float(half)), half);
  }
}

TEST(Half, RoundsToTheNextOneBelow) {
  std::mt19937 random(1);
  for (int i = 0; i < 200000; ++i) {
    // All exponents alike: from below the smallest subnormal to above the largest f16.
    const int exponent = static_cast<int>(random() % 48) - 30;
    const float value =
        std::ldexp(1.0f + static_cast<float>(random() % 0x800000) * 0x1p-23f, exponent);
    const std::uint16_t half = half_toward_zero(value);
    ASSERT_LE(half_to_float(half), value);
    if (half == 0x7bff) continue;  // saturated
    ASSERT_GT(half_to_float(static_cast<std::uint16_t>(half + 1)), value) << value;
  }
  EXPECT_EQ(half_toward_zero(1e9f), 0x7bff);
}

}  // namespace
}  // namespace boxtree
