// SPDX-License-Identifier: MIT
// Words that a shell reads back as the file names they were.
#include "cooker/report/shell_word.h"

#include <gtest/gtest.h>

namespace boxtree::cooker {
namespace {

TEST(ShellWord, QuotesWhatAShellWouldRead) {
  EXPECT_EQ(shell_word("bunny.obj"), "bunny.obj");
  EXPECT_EQ(shell_word("a+b_c-1@2x.glb"), "a+b_c-1@2x.glb");
  EXPECT_EQ(shell_word("my mesh.obj"), "'my mesh.obj'");
  EXPECT_EQ(shell_word("$(exit)`&;*?~.obj"), "'$(exit)`&;*?~.obj'");
  EXPECT_EQ(shell_word("it's.obj"), R"('it'\''s.obj')");
  EXPECT_EQ(shell_word("\xc3\xa4.obj"), "'\xc3\xa4.obj'");
  EXPECT_EQ(shell_word(""), "''");
}

TEST(ShellWord, IsNoOption) {
  EXPECT_EQ(shell_word("-o.obj"), "./-o.obj");
  EXPECT_EQ(shell_word("-o 1.obj"), "./'-o 1.obj'");
}

}  // namespace
}  // namespace boxtree::cooker
