// SPDX-License-Identifier: MIT
// Scans a TOML text once: skips strings and comments, counts the dots of keys.
#include "cooker/scene/toml_checks.h"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "cooker/text/utf8.h"

namespace boxtree::cooker {
namespace {

class Scan {
 public:
  explicit Scan(std::string_view text) : text_(text) {}

  std::optional<TomlFault> run() {
    if (text_.starts_with(kByteOrderMark)) at_ = kByteOrderMark.size();
    while (at_ < text_.size() && !fault_) step();
    if (!fault_ && is_header_) end_of_line();
    return fault_;
  }

 private:
  void step() {
    const char c = text_[at_++];
    switch (c) {
      case '\n':
        end_of_line();
        return;
      case ' ':
      case '\t':
      case '\r':
        return;
      case '#':
        at_ = std::min(text_.find('\n', at_), text_.size());
        return;
      case '"':
      case '\'':
        if (!may_begin_string())
          add("a string stands by itself, not beside a word or another string");
        has_begun_ = true;
        pass_string(c);
        return;
      case '.':
        has_begun_ = true;
        if (++dots_ >= kMaxKeyParts) add(fmt::format("a key of more than {} parts", kMaxKeyParts));
        return;
      case '[':
        if (!has_begun_) {
          has_begun_ = is_header_ = true;
          return;
        }
        if (is_value_) open_ += c;
        break;
      case '{':
        if (is_value_) open_ += c;
        expects_value_ = false;
        break;
      case ']':
        is_header_ = false;  // the name ends here; the parser checks the rest
        [[fallthrough]];
      case '}':
        if (!open_.empty()) open_.pop_back();
        expects_value_ = is_value_;
        break;
      case '=':
        is_value_ = expects_value_ = true;
        break;
      case ',':
        expects_value_ = is_value_ && (open_.empty() || open_.back() == '[');
        break;
      default:
        if (static_cast<unsigned char>(c) >= 0x80) {
          add("characters beyond ASCII stand in quotes or comments");
        }
        has_begun_ = true;
        return;
    }
    has_begun_ = true;
    dots_ = 0;  // the next is a key or a value
  }

  void end_of_line() {
    if (is_header_) add("the name of a table has to end on its line, by ']'");
    ++line_;
    dots_ = 0;
    if (open_.empty()) has_begun_ = is_value_ = expects_value_ = is_header_ = false;
  }

  // Whether a token begins at the quote before at_. Elsewhere the parser reads the quote and what
  // follows as part of a bare value. After a dot it begins a part of a key.
  [[nodiscard]] bool may_begin_string() const {
    constexpr std::string_view kBefore = " \t\r\n=[{,.";
    const std::string_view before = text_.substr(0, at_ - 1);
    if (before.empty() || before == kByteOrderMark) return true;
    return kBefore.find(before.back()) != std::string_view::npos &&
           !(before.back() == '.' && expects_value_);
  }

  // Starts after the first quote. The parser reports a single-line string without an end.
  void pass_string(char quote) {
    const std::string three(3, quote);
    if (text_.substr(at_ - 1, 3) != three) {
      while (at_ < text_.size() && text_[at_] != '\n') {
        const char c = text_[at_++];
        if (c == quote) return;
        if (c == '\\' && quote == '"' && at_ < text_.size() && text_[at_] != '\n') ++at_;
      }
      return;
    }
    at_ += 2;
    while (at_ < text_.size() && text_.substr(at_, 3) != three) {
      if (text_[at_] == '\n') ++line_;
      const bool escapes = text_[at_] == '\\' && quote == '"' && text_.substr(at_ + 1, 1) != "\n";
      at_ += escapes ? std::size_t{2} : 1;
    }
    at_ = std::min(at_ + 3, text_.size());
    // One or two more quotes belong to the string.
    for (int i = 0; i < 2 && at_ < text_.size() && text_[at_] == quote; ++i) ++at_;
  }

  void add(std::string what) {
    if (!fault_) fault_ = TomlFault{line_, std::move(what)};
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::uint32_t line_ = 1;
  std::uint32_t dots_ = 0;
  std::string open_;            // the brackets of arrays and inline tables
  bool has_begun_ = false;      // some part of a statement has been read
  bool is_value_ = false;       // after the '=' of a statement
  bool expects_value_ = false;  // not a key of an inline table there
  bool is_header_ = false;
  std::optional<TomlFault> fault_;
};

}  // namespace

std::optional<TomlFault> find_unreadable_toml(std::string_view text) {
  return Scan(text).run();
}

}  // namespace boxtree::cooker
