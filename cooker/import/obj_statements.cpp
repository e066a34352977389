// SPDX-License-Identifier: MIT
// A line scanner: indentation, comments, all kinds of line ends, lines joined by backslashes.
#include "cooker/import/obj_statements.h"

#include <algorithm>
#include <array>

#include "cooker/text/utf8.h"

namespace boxtree::cooker {
namespace {

bool is_line_end(char c) {
  return c == '\n' || c == '\r' || c == '\f';
}

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

// Tables of characters that end something; lookups are fast on long files.
constexpr std::array<bool, 256> set_of(std::string_view characters) {
  std::array<bool, 256> set{};
  for (const char c : characters) set[static_cast<unsigned char>(c)] = true;
  return set;
}
constexpr auto kLineEnds = set_of("\n\r\f");
constexpr auto kLineEndsOrJoins = set_of("\n\r\f\\");
constexpr auto kElementEnds = set_of("\n\r\f\\#");

std::size_t find_of(const std::array<bool, 256>& set, std::string_view text, std::size_t from) {
  while (from < text.size() && !set[static_cast<unsigned char>(text[from])]) ++from;
  return from;
}

// Statements of numbers. A hash begins a comment in them; names may contain one.
bool has_numbers(std::string_view text) {
  const std::string_view keyword = text.substr(0, text.find_first_of(" \t\\"));
  return keyword == "v" || keyword == "f" || keyword == "l" || keyword == "p" || keyword == "vt" ||
         keyword == "vn" || keyword == "vp" || keyword == "s" || keyword == "fo";
}

bool begins_with(std::string_view text, std::string_view keywords) {
  return text.size() > 1 && keywords.find(text[0]) != std::string_view::npos &&
         (is_blank(text[1]) || text[1] == '\\');
}

}  // namespace

bool ObjStatement::is_vertex() const {
  return begins_with(text, "v");
}

bool ObjStatement::is_element() const {
  return begins_with(text, "flp") || (text.starts_with("fo") && begins_with(text.substr(1), "o"));
}

std::string_view statements_of(std::string_view text) {
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  if (text.ends_with('\x1a')) text.remove_suffix(1);  // end of text in DOS
  return text;
}

// A comment ends with its line even after a backslash: paths end in backslashes, too.
bool ObjStatements::next(ObjStatement& statement) {
  if (rest_.empty()) return false;
  while (!rest_.empty() && is_blank(rest_[0])) rest_.remove_prefix(1);
  const std::string_view from = rest_;
  const std::size_t first_line = line_;
  const auto& ends = has_numbers(rest_) ? kElementEnds : kLineEndsOrJoins;
  std::size_t end = 0;
  std::size_t length = rest_.starts_with('#') ? 0 : std::string_view::npos;
  while (length == std::string_view::npos) {
    end = find_of(ends, rest_, end);
    if (end == rest_.size() || rest_[end] != '\\') {
      length = end;
    } else if (end + 1 < rest_.size() && is_line_end(rest_[end + 1])) {
      end += rest_.substr(end + 1).starts_with("\r\n") ? 3u : 2u;
      ++line_;
    } else {
      ++end;
    }
  }
  end = find_of(kLineEnds, rest_, end);
  if (rest_.substr(end).starts_with("\r\n")) ++end;
  if (end < rest_.size()) ++end;
  ++line_;
  rest_.remove_prefix(end);
  statement = {from.substr(0, length), first_line};
  return true;
}

std::string_view joined_text(const ObjStatement& statement, std::string& buffer) {
  if (statement.text.find('\\') == std::string_view::npos) return statement.text;
  buffer = statement.text;
  for (std::size_t i = 0; i + 1 < buffer.size(); ++i) {
    if (buffer[i] != '\\' || !is_line_end(buffer[i + 1])) continue;
    buffer[i] = ' ';
    while (i + 1 < buffer.size() && is_line_end(buffer[i + 1])) buffer[++i] = ' ';
  }
  if (buffer.ends_with('\\')) buffer.back() = ' ';
  return buffer;
}

}  // namespace boxtree::cooker
