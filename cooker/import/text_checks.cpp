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

Status check_element(const PlyElement& element, Lines& lines, Tokens& words) {
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
  }
  return {};
}

// Takes the words of a text STL file in their order. Lines mean nothing but after "solid" and
// "endsolid", where a name of any words follows; outside of facets unknown words are passed over.
class StlChecker {
 public:
  explicit StlChecker(std::string_view file) : lines_(file) {}

  Status run() {
    while (lines_.next(words_)) {
      for (const std::string_view word : words_) {
        if (Status status = take(word); !status.ok()) return status;
        if (is_name_) break;
      }
      is_name_ = false;
    }
    if (corners_ != kOutside) return lines_.failure("the file ends within a facet");
    return is_open_ ? Status(lines_.failure("the file ends without 'endsolid'")) : Status();
  }

 private:
  static constexpr int kOutside = -1;

  Status take(std::string_view given) {
    if (numbers_ > 0) {
      --numbers_;
      return read_number<double>(given) ? Status() : failure(given, "is no number");
    }
    std::string word = after_end_ ? "end" : "";  // some write "end facet"
    for (const char c : given) word += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    after_end_ = word == "end";
    if (after_end_) return {};
    return corners_ == kOutside ? take_outside(word) : take_inside(word, given);
  }

  Status take_outside(std::string_view word) {
    if (word == "solid" || word == "endsolid") {
      is_open_ = word == "solid";
      is_name_ = true;
    } else if (word == "facet") {
      corners_ = 0;
    }
    return {};
  }

  Status take_inside(std::string_view word, std::string_view given) {
    if (word == "normal" || word == "vertex") {
      numbers_ = 3;
      corners_ += word == "vertex" ? 1 : 0;
    } else if (word == "endfacet") {
      if (corners_ != 3) return lines_.failure(fmt::format("a facet of {} corners", corners_));
      corners_ = kOutside;
    } else if (word != "outer" && word != "loop" && word != "endloop") {
      return failure(given, "within a facet");
    }
    return {};
  }

  [[nodiscard]] Status failure(std::string_view word, std::string_view what) const {
    return lines_.failure(fmt::format("'{}' {}", word, what));
  }

  Lines lines_;
  Tokens words_;
  bool is_open_ = false;    // a solid is
  bool is_name_ = false;    // the rest of the line is
  bool after_end_ = false;  // the word before was "end"
  int corners_ = kOutside;  // of the facet at hand
  int numbers_ = 0;         // that are to come
};

}  // namespace

Status check_ply_text(std::string_view file) {
  const std::optional<PlyHeader> header = read_ply_header(file);
  if (!header) return Error{Errc::kImportFailed, "an element of the header has no count"};
  if (header->form != PlyHeader::Form::kText) return {};
  const std::string_view before = file.substr(0, header->bytes);
  Lines lines(file.substr(header->bytes),
              static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n')));
  Tokens words;
  for (const PlyElement& element : header->elements) {
    if (Status status = check_element(element, lines, words); !status.ok()) return status;
  }
  return {};
}

Status check_stl_text(std::string_view file) {
  const std::size_t start = std::min(file.find_first_not_of(" \t\r\n"), file.size());
  return file.substr(start).starts_with("solid") ? StlChecker(file).run() : Status();
}

bool has_open_end(std::string_view text) {
  return !text.empty() && text.back() != '\n' && text.back() != '\r';
}

}  // namespace boxtree::cooker
