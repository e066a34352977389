// SPDX-License-Identifier: MIT
// Words and numbers as the readers of text formats take them: all of a word, or nothing of it.
#include "cooker/import/text_tokens.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

#include <gtest/gtest.h>

namespace boxtree::cooker {
namespace {

using namespace std::string_view_literals;

TEST(TextTokens, IntegersHaveOneSignAtMost) {
  EXPECT_EQ(read_integer("7"), 7);
  EXPECT_EQ(read_integer("+7"), 7);
  EXPECT_EQ(read_integer("-7"), -7);
  EXPECT_EQ(read_integer("-0"), 0);
  EXPECT_EQ(read_integer("0007"), 7);
  EXPECT_EQ(read_integer("-9223372036854775808"), std::numeric_limits<std::int64_t>::min());
  for (const std::string_view word : {"", "+", "-", "+-7", "-+7", "++7", "--7", "7.0", "7e0", "0x7",
                                      "7 ", " 7", "7/1", "9223372036854775808"}) {
    EXPECT_EQ(read_integer(word), std::nullopt) << word;
  }
}

TEST(TextTokens, CountsHaveNoSign) {
  EXPECT_EQ(read_count("0"), 0u);
  EXPECT_EQ(read_count("18446744073709551615"), std::numeric_limits<std::uint64_t>::max());
  for (const std::string_view word : {"", "+1", "-1", "1.0", "18446744073709551616"}) {
    EXPECT_EQ(read_count(word), std::nullopt) << word;
  }
}

TEST(TextTokens, NumbersAreRoundedOnceAndInfiniteBeyondTheirRange) {
  EXPECT_EQ(read_number<float>("+0.1"), 0.1f);
  EXPECT_EQ(read_number<double>("-.5e1"), -5.0);
  // Between two floats; by way of a double the tie would go to the even one below.
  EXPECT_EQ(read_number<float>("1.00000005960464477540"), 0x1.000002p0f);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(read_number<float>("1e39"), kInfinity);
  EXPECT_EQ(read_number<float>("-1e99999999999999999999"), -kInfinity);
  EXPECT_EQ(read_number<float>("1e-99999999999999999999"), 0.0f);
  EXPECT_TRUE(std::signbit(*read_number<float>("-1e-60")));
  EXPECT_TRUE(std::isnan(*read_number<float>("nan")));
  for (const std::string_view word : {"", "+", "1,5", "2m", "0x10", "+-1", "1e", "1 "}) {
    EXPECT_EQ(read_number<double>(word), std::nullopt) << word;
  }
}

TEST(TextTokens, LinesEndAsOnAnySystem) {
  std::string_view rest = "a\nb\r\nc\rd\n\ne";
  for (const std::string_view line : {"a", "b", "c", "d", "", "e"}) {
    ASSERT_FALSE(rest.empty());
    EXPECT_EQ(take_line(rest), line);
  }
  EXPECT_TRUE(rest.empty());
}

TEST(TextTokens, WordsStandBetweenBlanks) {
  Tokens words;
  split_tokens(" \t one\f two\vthree\r\n", words);
  EXPECT_EQ(words, (Tokens{"one", "two", "three"}));
  split_tokens(" \n", words);
  EXPECT_TRUE(words.empty());
}

TEST(TextTokens, ZerosFillUpAnEndAndNothingElse) {
  EXPECT_EQ(*text_of("v 1\0\0"sv), "v 1");
  const Result<std::string_view> text = text_of("a\nb\0c\n"sv);
  ASSERT_FALSE(text.ok());
  EXPECT_EQ(text.error().detail, "line 2: a zero byte: no text, or one in UTF-16");
}

TEST(TextTokens, ExtensionsAreTheLastOneInAnyCase) {
  EXPECT_TRUE(has_extension("a.b.OBJ", "obj"));
  EXPECT_FALSE(has_extension("a.obj.gz", "obj"));
  EXPECT_FALSE(has_extension("obj", "obj"));
}

}  // namespace
}  // namespace boxtree::cooker
