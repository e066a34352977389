// SPDX-License-Identifier: MIT
#include "cooker/write/temporary_name.h"

#include <gtest/gtest.h>

#include "cooker/text/utf8.h"

namespace boxtree::cooker {
namespace {

TEST(TemporaryName, BelongsToItsTargetAlone) {
  const std::string name = temporary_name("level.bxt");
  EXPECT_TRUE(is_temporary_name(name, temporary_prefix("level.bxt")));
  EXPECT_FALSE(is_temporary_name(name, temporary_prefix("level")));
  EXPECT_NE(name, temporary_name("level.bxt"));
}

// Names of files have 255 bytes at most, on Windows as many halves of UTF-16.
TEST(TemporaryName, OfALongNameIsCutBetweenCharacters) {
  for (const std::string character : {"x", "\xc3\xa9", "\xe6\x97\xa5", "\xf0\x9f\x8c\xb3"}) {
    for (const std::string before : {"", "a", "ab", "abc"}) {
      std::string target = before;
      while (target.size() + character.size() <= 255) target += character;
      const std::string name = temporary_name(target);
      EXPECT_LE(name.size(), 255u);
      EXPECT_TRUE(is_utf8(name)) << name;
      EXPECT_TRUE(is_temporary_name(name, temporary_prefix(target)));
    }
  }
  EXPECT_LE(temporary_name(std::string(255, '\x80')).size(), 255u);
}

}  // namespace
}  // namespace boxtree::cooker
