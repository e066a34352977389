// SPDX-License-Identifier: MIT
#include "cooker/text/percent.h"

#include <gtest/gtest.h>

namespace boxtree::cooker {
namespace {

TEST(Percent, EncodesAllButPlainCharacters) {
  EXPECT_EQ(percent_encoded("a/B-9_.~ %\xc3\xa9"), "a/B-9_.~%20%25%C3%A9");
}

TEST(Percent, DecodesCodes) {
  EXPECT_EQ(percent_decoded("my%20three%2ebin%C3%a9"), "my three.bin\xc3\xa9");
}

TEST(Percent, LeavesWhatIsNoCode) {
  for (const char* text : {"", "%", "%2", "50%", "%zz", "%2g", "%+2", "% 2", "%00", "a%0"}) {
    EXPECT_EQ(percent_decoded(text), text);
  }
}

TEST(Percent, DecodesWhatItEncodes) {
  std::string all;
  for (int c = 1; c < 256; ++c) all += static_cast<char>(c);
  EXPECT_EQ(percent_decoded(percent_encoded(all)), all);
}

}  // namespace
}  // namespace boxtree::cooker
