// SPDX-License-Identifier: MIT
#include "cooker/report/shell_word.h"

#include <algorithm>

namespace boxtree::cooker {
namespace {

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view("%+,-./:@_").find(c) != std::string_view::npos;
}

}  // namespace

std::string shell_word(std::string_view file_name) {
  std::string word = file_name.starts_with('-') ? "./" : "";
  if (!file_name.empty() && std::ranges::all_of(file_name, is_plain)) return word.append(file_name);
  word += '\'';
  for (const char c : file_name) {
    if (c == '\'')
      word += R"('\'')";
    else
      word += c;
  }
  return word += '\'';
}

}  // namespace boxtree::cooker
