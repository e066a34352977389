// SPDX-License-Identifier: MIT
// When other programs disturbed a measurement: by numbers, since times of tests depend on the
// machine.
#include "cooker/report/timed_work.h"

#include <gtest/gtest.h>

namespace boxtree::cooker {
namespace {

TEST(TimedWork, HasTheShareOfItsProcessorTime) {
  EXPECT_EQ(TimedWork().processor_share(), 1);
  EXPECT_EQ(TimedWork(0.5, 2).processor_share(), 0.25);
  // Two clocks may differ by their steps.
  EXPECT_EQ(TimedWork(1.001, 1).processor_share(), 1);
}

TEST(TimedWork, OfSeveralCallsIsTheirSum) {
  TimedWork work(0, 1);
  EXPECT_EQ(work.add([] { return 7; }), 7);
  EXPECT_LT(work.processor_share(), 1) << "the second in which nothing ran counts";
}

// One program that wants the processor as much has it for half of the time.
TEST(TimedWork, IsDisturbedByProgramsThatHaveTheProcessor) {
  EXPECT_FALSE(is_disturbed(1));
  EXPECT_FALSE(is_disturbed(0.99));
  EXPECT_TRUE(is_disturbed(0.5));
  EXPECT_TRUE(is_disturbed(0));
}

}  // namespace
}  // namespace boxtree::cooker
