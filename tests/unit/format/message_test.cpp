// SPDX-License-Identifier: MIT
// Texts of errors that are made in one place.
#include "format/message.h"

#include <gtest/gtest.h>

namespace boxtree {
namespace {

TEST(ErrorWith, ReplacesSignsByNumbersInTheTextAlone) {
  EXPECT_EQ(error_with(Errc::kTreeIndex, "at #: ", "# of #", {1, 20}).detail, "at #: 1 of 20");
  EXPECT_EQ(error_with(Errc::kTreeIndex, {}, "# stays").detail, "# stays");
}

TEST(ErrorAt, PutsThePlaceInFront) {
  const Error error = error_at("tree #1: ", {Errc::kTreeIndex, "no # here"});
  EXPECT_EQ(error.code, Errc::kTreeIndex);
  EXPECT_EQ(error.detail, "tree #1: no # here");
}

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
