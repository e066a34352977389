// SPDX-License-Identifier: MIT
// Lists of faces to drop: what is read, and what is refused.
#include "cooker/scene/hidden_faces.h"

#include <gtest/gtest.h>

namespace boxtree::cooker {
namespace {

std::vector<std::pair<std::uint32_t, std::uint32_t>> read(std::string_view text) {
  const auto ranges = parse_hidden_faces(text, "list.txt");
  EXPECT_TRUE(ranges.ok()) << ranges.error().message();
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (const FaceRange& range : *ranges) pairs.emplace_back(range.first, range.last);
  return pairs;
}

std::string fault_of_list(std::string_view text) {
  const auto ranges = parse_hidden_faces(text, "list.txt");
  EXPECT_FALSE(ranges.ok()) << text;
  return ranges.ok() ? "" : ranges.error().detail;
}

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

TEST(HiddenFaces, AFaceIsLookedUpInItsRange) {
  const std::vector<FaceRange> ranges = {{3, 3}, {7, 9}};
  for (std::uint32_t face = 0; face < 12; ++face) {
    EXPECT_EQ(is_hidden(ranges, face), face == 3 || (face >= 7 && face <= 9)) << face;
  }
  EXPECT_FALSE(is_hidden({}, 0));
}

TEST(HiddenFaces, NumbersAndRangesInAnyOrder) {
  EXPECT_EQ(read("40\n7 - 9  # below ground\n\n# a comment\r\n\t3\r\n"),
            (Pairs{{3, 3}, {7, 9}, {40, 40}}));
  EXPECT_EQ(read(""), Pairs{});
  EXPECT_EQ(read("5"), (Pairs{{5, 5}}));
}

TEST(HiddenFaces, WhatTouchesIsJoined) {
  EXPECT_EQ(read("1-3\n4\n6-9\n7\n5"), (Pairs{{1, 9}}));
  EXPECT_EQ(read("1-9\n2-3\n11"), (Pairs{{1, 9}, {11, 11}}));
  EXPECT_EQ(read("4294967295\n0"), (Pairs{{0, 0}, {4294967295u, 4294967295u}}));
  EXPECT_EQ(read("4294967295\n4294967295"), (Pairs{{4294967295u, 4294967295u}}));
}

TEST(HiddenFaces, FaultsNameTheirLine) {
  const std::string expected = "expected the number of a face, or a range as 12-40, found ";
  EXPECT_EQ(fault_of_list("1\n2\nabc\n"), "list.txt:3: " + expected + "\"abc\"");
  EXPECT_EQ(fault_of_list("9-7"), "list.txt:1: " + expected + "\"9-7\"");
  EXPECT_EQ(fault_of_list("\n-4"), "list.txt:2: " + expected + "\"-4\"");
  EXPECT_EQ(fault_of_list("1 2"), "list.txt:1: " + expected + "\"1 2\"");
  EXPECT_EQ(fault_of_list("1.5"), "list.txt:1: " + expected + "\"1.5\"");
  EXPECT_EQ(fault_of_list("4294967296"), "list.txt:1: " + expected + "\"4294967296\"");
}

}  // namespace
}  // namespace boxtree::cooker
