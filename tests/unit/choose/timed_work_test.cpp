// SPDX-License-Identifier: MIT
// When other programs disturbed a measurement: by numbers, since times of tests depend on the
// machine.
#include "cooker/choose/timed_work.h"

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
  TimedWork alone;
  EXPECT_EQ(alone.speed_ratio(), 1);
  EXPECT_EQ(alone.add([] { return 8; }), 8);
  EXPECT_GE(alone.speed_ratio(), 1);
}

// One program that wants the processor as much has it for half of the time.
TEST(TimedWork, IsDisturbedByProgramsThatHaveTheProcessor) {
  EXPECT_FALSE(TimedWork().is_disturbed());
  EXPECT_FALSE(TimedWork(0.99, 1).is_disturbed());
  for (const double seconds : {0.5, 0.0}) {
    EXPECT_TRUE(TimedWork(seconds, 1).lacks_processor());
    EXPECT_TRUE(TimedWork(seconds, 1).is_disturbed());
  }
}

// A core whose other thread is busy, or a virtual machine whose host is, is slower and has all the
// time: nothing is missing of its processor time.
TEST(TimedWork, IsDisturbedByAProcessorThatIsSlowerAtTimes) {
  EXPECT_FALSE(TimedWork(1, 1, 1.05).is_disturbed());
  EXPECT_FALSE(TimedWork(1, 1, 1.4).lacks_processor());
  EXPECT_TRUE(TimedWork(1, 1, 1.4).is_disturbed());
  EXPECT_EQ(TimedWork(1, 1, 1.4).speed_ratio(), 1.4);
}

}  // namespace
}  // namespace boxtree::cooker
