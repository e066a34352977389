// SPDX-License-Identifier: MIT
#include "cooker/text/utf8.h"

#include <algorithm>

namespace boxtree::cooker {
namespace {

constexpr std::string_view kReplacement = "\xef\xbf\xbd";

bool is_between(unsigned x, unsigned low, unsigned high) {
  return low <= x && x <= high;
}

}  // namespace

std::size_t character_bytes(std::string_view text) {
  const auto byte = [&](std::size_t i) -> unsigned {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
  };
  const auto continues = [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i <= to; ++i) {
      if (!is_between(byte(i), 0x80, 0xbf)) return false;
    }
    return true;
  };
  if (text.empty()) return 0;
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  if (is_between(first, 0xc2, 0xdf)) return continues(1, 1) ? 2 : 0;
  if (is_between(first, 0xe0, 0xef)) {
    const bool fits = first == 0xe0 ? byte(1) >= 0xa0 : first != 0xed || byte(1) <= 0x9f;
    return fits && continues(1, 2) ? 3 : 0;
  }
  if (is_between(first, 0xf0, 0xf4)) {
    const bool fits = first == 0xf0 ? byte(1) >= 0x90 : first != 0xf4 || byte(1) <= 0x8f;
    return fits && continues(1, 3) ? 4 : 0;
  }
  return 0;
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t bytes = character_bytes(text);
    if (bytes == 0) return false;
    text.remove_prefix(bytes);
  }
  return true;
}

std::string to_utf8(std::string_view text, std::size_t most) {
  std::string out;
  while (!text.empty()) {
    const std::size_t bytes = character_bytes(text);
    const std::string_view character = bytes > 0 ? text.substr(0, bytes) : kReplacement;
    if (character.size() > most - out.size()) break;
    out += character;
    text.remove_prefix(std::max<std::size_t>(bytes, 1));
  }
  return out;
}

}  // namespace boxtree::cooker
