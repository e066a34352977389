// SPDX-License-Identifier: MIT
// Texts of errors that are made in one place.
#include "format/message.h"

#include <gtest/gtest.h>

namespace boxtree {
namespace {

TEST(IndexError, SaysWhichNumbersThereAre) {
  const auto detail = [](std::uint64_t index, std::uint64_t count) {
    return index_error(Errc::kTreeIndex, "tree", index, count).detail;
  };
  EXPECT_EQ(detail(3, 0), "there is no tree 3, nor any other");
  EXPECT_EQ(detail(1, 1), "there is no tree 1; expected 0");
  EXPECT_EQ(detail(2, 2), "there is no tree 2; expected 0 or 1");
  EXPECT_EQ(detail(9, 3), "there is no tree 9; expected 0 to 2");
  EXPECT_EQ(index_error(Errc::kInstanceIndex, "instance", 1, 1).code, Errc::kInstanceIndex);
}

}  // namespace
}  // namespace boxtree
