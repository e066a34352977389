// SPDX-License-Identifier: MIT
// Texts that functions of the C interface copy.
#pragma once

#include <cstddef>
#include <string>

#include <gtest/gtest.h>

namespace boxtree::test {

// A text that `copy(buffer, capacity)` copies, with every room for it.
template <class Copy>
std::string copied_text(const Copy& copy) {
  const std::size_t length = copy(nullptr, std::size_t{0});
  std::string text(length + 1, '#');
  EXPECT_EQ(copy(text.data(), length + 1), length);
  EXPECT_EQ(text[length], '\0');
  text.resize(length);
  for (std::size_t room = 1; room <= length; ++room) {
    std::string cut(length + 1, '#');
    EXPECT_EQ(copy(cut.data(), room), length);
    EXPECT_EQ(cut.substr(0, room), text.substr(0, room - 1) + '\0');
    EXPECT_EQ(cut.substr(room), std::string(length + 1 - room, '#'));
  }
  return text;
}

}  // namespace boxtree::test
