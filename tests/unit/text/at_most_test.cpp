// SPDX-License-Identifier: MIT
#include "cooker/text/at_most.h"

#include <cmath>
#include <optional>
#include <random>

#include <gtest/gtest.h>

#include "cooker/text/number_of.h"

namespace boxtree::cooker {
namespace {

TEST(AtMost, IsTheNextNumberOfSoManyDigits) {
  EXPECT_EQ(at_most(0, 3), "0");
  EXPECT_EQ(at_most(0.0099, 2), "0.0099");
  EXPECT_EQ(at_most(0.00635061, 3), "0.00636");
  EXPECT_EQ(at_most(0.00635, 3), "0.00635");
  EXPECT_EQ(at_most(5.4030e-06, 2), "5.5e-06");
  EXPECT_EQ(at_most(9.9901, 3), "10");
  EXPECT_EQ(at_most(99.96, 3), "100");
  EXPECT_EQ(at_most(0.0009995001, 3), "0.001");
  EXPECT_EQ(at_most(1234, 3), "1.24e+03");
  EXPECT_EQ(at_most(1.0000001e300, 3), "1.01e+300");
  EXPECT_EQ(at_most(1, 1), "1");
}

TEST(AtMost, HoldsAndIsNoFartherThanADigit) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> exponent(-300, 300);
  for (int i = 0; i < 20000; ++i) {
    const double bound = std::pow(10.0, exponent(random));
    for (const int digits : {1, 2, 3, 6}) {
      const std::optional<double> told = number_of<double>(at_most(bound, digits));
      ASSERT_TRUE(told);
      ASSERT_GE(*told, bound) << digits;
      ASSERT_LE(*told, bound * (1 + std::pow(10.0, 1 - digits))) << digits;
    }
  }
}

}  // namespace
}  // namespace boxtree::cooker
