// SPDX-License-Identifier: MIT
// Texts from files and paths, which may be invalid UTF-8.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace boxtree::cooker {

/// Bytes of the first character of a text; 0 if it is not UTF-8 (Unicode 15, table 3-7), or if the
/// text is empty.
[[nodiscard]] std::size_t character_bytes(std::string_view text);

/// What some programs for Windows write before a text.
inline constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

[[nodiscard]] bool is_utf8(std::string_view text);

/// The text with U+FFFD in place of each byte that is not UTF-8; at most `most` bytes, cut between
/// characters. Names in files: docs/FORMAT.md.
[[nodiscard]] std::string to_utf8(std::string_view text, std::size_t most = std::string::npos);

}  // namespace boxtree::cooker
