// SPDX-License-Identifier: MIT
#include "cooker/text/utf8.h"

#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace boxtree::cooker {
namespace {

// A character by its number, as UTF-8 was defined before numbers were ruled out: by shifting bits.
std::string encoded(unsigned number) {
  const auto byte = [](unsigned value) { return static_cast<char>(value); };
  const auto next = [&](unsigned shift) { return byte(0x80 | ((number >> shift) & 0x3f)); };
  if (number < 0x80) return {byte(number)};
  if (number < 0x800) return {byte(0xc0 | number >> 6), next(0)};
  if (number < 0x10000) return {byte(0xe0 | number >> 12), next(6), next(0)};
  return {byte(0xf0 | number >> 18), next(12), next(6), next(0)};
}

TEST(Utf8, EveryCharacterIsOneAndNoSurrogateIs) {
  for (unsigned number = 0; number < 0x110000; ++number) {
    const std::string character = encoded(number);
    const bool is_surrogate = 0xd800 <= number && number <= 0xdfff;
    ASSERT_EQ(character_bytes(character), is_surrogate ? 0 : character.size()) << number;
    ASSERT_EQ(is_utf8(character), !is_surrogate) << number;
    for (std::size_t size = 1; size < character.size(); ++size) {
      ASSERT_EQ(character_bytes(character.substr(0, size)), 0u) << number;
    }
  }
  EXPECT_FALSE(is_utf8(encoded(0x110000)));
  EXPECT_EQ(character_bytes(""), 0u);
  EXPECT_TRUE(is_utf8(""));
}

TEST(Utf8, SpellingsThatAreTooLongAreNone) {
  for (const std::string_view text : {"\xc0\x80", "\xc1\xbf", "\xe0\x9f\xbf", "\xf0\x8f\xbf\xbf",
                                      "\xf5\x80\x80\x80", "\x80", "\xff", "\xc3("}) {
    EXPECT_FALSE(is_utf8(text));
    EXPECT_EQ(character_bytes(text), 0u);
  }
}

TEST(Utf8, WhatIsNoneIsReplacedByteByByte) {
  EXPECT_EQ(to_utf8("t\xc3\xbcr"), "t\xc3\xbcr");
  EXPECT_EQ(to_utf8("a\xff"
                    "b\xc3"),
            "a\xef\xbf\xbd"
            "b\xef\xbf\xbd");
  EXPECT_EQ(to_utf8(std::string_view("\0x", 2)), std::string_view("\0x", 2));
}

TEST(Utf8, IsCutBetweenCharacters) {
  const std::string_view text = "a\xc3\xbc\xf0\x9f\x98\x80z";
  const std::size_t whole[] = {0, 1, 1, 3, 3, 3, 3, 7, 8, 8};
  for (std::size_t most = 0; most < std::size(whole); ++most) {
    EXPECT_EQ(to_utf8(text, most), text.substr(0, whole[most])) << most;
  }
  EXPECT_EQ(to_utf8("\xff", 2), "");
}

}  // namespace
}  // namespace boxtree::cooker
