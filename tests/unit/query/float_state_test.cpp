// SPDX-License-Identifier: MIT
// Queries compute in a state of their own and leave the caller's as it was.
#include "tests/support/float_state.h"

#include <cfenv>

#include <gtest/gtest.h>

#include "runtime/primitive/float_state.h"

namespace boxtree {
namespace {

TEST(DefaultFloatState, RoundsToNearestInside) {
  const test::RoundingMode<FE_UPWARD> upward;
  volatile float one = 1, tiny = 0x1p-40F;
  {
    const DefaultFloatState state;
    EXPECT_EQ(one + tiny, 1.0F);
  }
  EXPECT_GT(one + tiny, 1.0F) << "the caller's mode is back";
}

TEST(DefaultFloatState, KeepsSubnormalNumbersInside) {
  if (!test::FlushToZero::is_supported()) GTEST_SKIP() << "no such state on this machine";
  const test::FlushToZero flush;
  volatile float tiny = 0x1p-140F;
  {
    const DefaultFloatState state;
    EXPECT_EQ(tiny * 2, 0x1p-139F);
  }
  EXPECT_EQ(tiny * 2, 0.0F) << "the caller's state is back";
}

}  // namespace
}  // namespace boxtree
