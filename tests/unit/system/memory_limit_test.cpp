// SPDX-License-Identifier: MIT
// Limits of control groups, of either version, in folders that look like the system's.
#include "cooker/system/memory_limit.h"

#include <optional>

#include <gtest/gtest.h>

#include "tests/support/temp_folder.h"

namespace boxtree::cooker {
namespace {

using Limit = std::optional<std::uint64_t>;

TEST(MemoryLimit, IsTheLeastOfAGroupAndOfThoseAboveIt) {
  const test::TempFolder folder;
  folder.write("memory.max", "max\n");
  folder.write("slurm/memory.max", "8000\n");
  folder.write("slurm/job/memory.max", "9000\n");
  folder.write("slurm/job/task/memory.max", "max\n");
  const auto limit = [&](const char* groups) { return memory_limit(groups, folder.path()); };
  EXPECT_EQ(limit("0::/slurm/job/task\n"), Limit(8000));
  EXPECT_EQ(limit("0::/slurm/job"), Limit(8000));
  EXPECT_EQ(limit("0::/\n"), Limit());
  folder.write("slurm/job/memory.max", "7000\n");
  EXPECT_EQ(limit("0::/slurm/job/task\n"), Limit(7000));
}

// A container sees its own group as the root, and is told where that is outside.
TEST(MemoryLimit, OfAGroupThatIsNotThereIsThatOfTheRoot) {
  const test::TempFolder folder;
  folder.write("memory.max", "5000\n");
  EXPECT_EQ(memory_limit("0::/kubepods/pod1\n", folder.path()), Limit(5000));
}

TEST(MemoryLimit, OfVersion1IsThatOfItsController) {
  const test::TempFolder folder;
  folder.write("memory/task/memory.limit_in_bytes", "3000\n");
  folder.write("cpu/task/memory.limit_in_bytes", "2000\n");
  EXPECT_EQ(memory_limit("9:name=systemd:/\n4:memory:/task\n1:cpu:/task\n0::/\n", folder.path()),
            Limit(3000));
}

TEST(MemoryLimit, IsNoneWhereNothingSaysOne) {
  const test::TempFolder folder;
  for (const char* groups : {"", "\n", ":", "::", "0::/none", "garbage", "4:memory:/x\n"}) {
    EXPECT_EQ(memory_limit(groups, folder.path()), Limit()) << groups;
  }
  folder.write("memory.max", "99999999999999999999999\n");
  EXPECT_EQ(memory_limit("0::/\n", folder.path()), Limit());
}

}  // namespace
}  // namespace boxtree::cooker
