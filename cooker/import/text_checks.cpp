// SPDX-License-Identifier: MIT
// Line by line, word by word, without keeping any of it.
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <fmt/format.h>

#include <boxtree/cooker/import/ply_header.h>
#include <boxtree/cooker/import/text_checks.h>
#include <boxtree/cooker/import/text_tokens.h>

namespace boxtree::cooker {
namespace {

// The lines of a text that hold a word, one after the other.
class Lines {
 public:
  explicit Lines(std::string_view text, std::size_t number = 0) : rest_(text), number_(number) {}

  // Leaves the words of the next one in `words`; false at the end.
  bool next(Tokens& words) {
    while (!rest_.empty()) {
      split_tokens(take_line(rest_), words);
      ++number_;
      if (!words.empty()) return true;
    }
    return false;
  }

  [[nodiscard]] std::size_t number() const { return number_; }

  [[nodiscard]] Error failure(std::string_view why) const {
    return Error{Errc::kImportFailed, fmt::format("line {}: {}", number_, why)};
  }

 private:
  std::string_view rest_;
  std::size_t number_;  // of the line at hand, from 1
};

// How many words an element takes by its properties and by the lengths of its lists; or what is
// wrong with it.
Result<std::uint64_t> words_of(const PlyElement& element, const Tokens& words, const Lines& lines) {
  std::uint64_t wanted = 0;
  for (const PlyProperty& property : element.properties) {
    if (property.length && wanted < words.size()) {
      const std::optional<std::uint64_t> count = read_count(words[wanted]);
      if (!count || *count > words.size()) {
        return lines.failure(fmt::format("a list of '{}' numbers, but the line has {} words",
                                         words[wanted], words.size()));
      }
      wanted += *count;
    }
    ++wanted;
  }
  return wanted;
}

Status read_element(const PlyElement& element, Lines& lines, Tokens& words,
                    const PlyRowVisitor& visit) {
  if (element.is_understood && element.properties.empty()) return {};
  for (std::uint64_t i = 0; i < element.count; ++i) {
    if (!lines.next(words)) {
      return lines.failure(
          fmt::format("the file ends after {} of {} '{}'", i, element.count, element.name));
    }
    if (!element.is_understood) continue;
    const Result<std::uint64_t> wanted = words_of(element, words, lines);
    if (!wanted.ok()) return wanted.error();
    if (*wanted != words.size()) {
      return lines.failure(fmt::format("'{}' {} has {} words; its properties take {}", element.name,
                                       i, words.size(), *wanted));
    }
    const std::string_view no_number = find_no_number(std::span(words));
    if (!no_number.empty()) return lines.failure(fmt::format("'{}' is no number", no_number));
    if (Status status = visit(element, words, lines.number()); !status.ok()) return status;
  }
  return {};
}

}  // namespace

Status read_ply_rows(const PlyHeader& header, std::string_view file, const PlyRowVisitor& visit) {
  const std::string_view before = file.substr(0, header.bytes);
  Lines lines(file.substr(header.bytes),
              static_cast<std::size_t>(std::max(std::count(before.begin(), before.end(), '\n'),
                                                std::count(before.begin(), before.end(), '\r'))));
  Tokens words;
  for (const PlyElement& element : header.elements) {
    if (Status status = read_element(element, lines, words, visit); !status.ok()) return status;
  }
  return {};
}

Status check_ply_text(std::string_view file) {
  const std::optional<PlyHeader> header = read_ply_header(file);
  if (!header)
    return Error{Errc::kImportFailed,
                 "an element of the header has no count, or a property no element"};
  if (header->form != PlyHeader::Form::kText) return {};
  return read_ply_rows(*header, file,
                       [](const PlyElement&, const Tokens&, std::size_t) { return Status(); });
}

bool has_open_end(std::string_view text) {
  return !text.empty() && text.back() != '\n' && text.back() != '\r';
}

}  // namespace boxtree::cooker
