// SPDX-License-Identifier: MIT
// Numbers in words of command lines, profiles and files of the cooker.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace boxtree::cooker {

/// All of `text` as a number of type T; nothing if it is none, or one that T does not hold.
template <class T>
[[nodiscard]] std::optional<T> number_of(std::string_view text) {
  T number{};
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && stopped == end ? std::optional(number) : std::nullopt;
}

}  // namespace boxtree::cooker
