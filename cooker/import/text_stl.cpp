// SPDX-License-Identifier: MIT
// Reads text STL word by word. Line ends matter only after "solid"
// and "endsolid", which are followed by a name of any words.
#include "cooker/import/text_stl.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "cooker/import/binary_stl.h"
#include "cooker/import/file_error.h"
#include "cooker/import/text_tokens.h"

namespace boxtree::cooker {
namespace {

// Headers of binary files may begin with "solid", too, but a text contains no zero byte.
constexpr std::size_t kShown = kStlHeaderBytes;

// T is the type of the positions.
template <class T>
class TextStlReader {
 public:
  TextStlReader(std::string_view text, const std::string& file, StlMesh<T>& mesh)
      : rest_(text), file_(file), mesh_(mesh) {}

  Status read() {
    const Result<std::string_view> text = text_of(rest_);
    if (!text.ok()) return in_file(file_, text.error());
    rest_ = *text;
    const char* const end = rest_.data() + rest_.size();
    while (!rest_.empty()) {
      split_tokens(take_line(rest_), words_);
      ++line_;
      is_name_ = false;
      for (const std::string_view word : words_) {
        is_last_ = word.data() + word.size() == end;
        if (Status status = take(word); !status.ok()) return status;
        if (is_name_) break;
      }
    }
    is_last_ = true;
    if (is_in_facet_) return failure("the file ends within a facet");
    if (is_open_) return failure("the file ends without 'endsolid'");
    return mesh_.finish();
  }

 private:
  Status take(std::string_view given) {
    if (numbers_left_ > 0) return take_number(given);
    std::string word = (after_end_ ? "end" : "") + in_lower_case(given);  // some write "end facet"
    after_end_ = word == "end";
    if (after_end_) return {};
    return is_in_facet_ ? take_inside(word, given) : take_outside(word, given);
  }

  // A number of a normal or of a corner.
  Status take_number(std::string_view given) {
    const std::optional<T> number = read_number<T>(given);
    if (!number) return failure(fmt::format("'{}' is no number", given));
    if (is_corner_ && corners_ <= 3) corner_[corners_ - 1][3 - numbers_left_] = *number;
    --numbers_left_;
    return {};
  }

  // Unknown words are refused: one could be a misspelt facet.
  Status take_outside(std::string_view word, std::string_view given) {
    if (word == (is_open_ ? "endsolid" : "solid")) {
      is_open_ = !is_open_;
      is_name_ = true;
    } else if (is_open_ && word == "facet") {
      is_in_facet_ = true;
      corners_ = 0;
    } else {
      return failure(
          fmt::format("'{}' instead of {}", given, is_open_ ? "'facet' or 'endsolid'" : "'solid'"));
    }
    return {};
  }

  Status take_inside(std::string_view word, std::string_view given) {
    if (word == "normal" || word == "vertex") {
      numbers_left_ = 3;
      is_corner_ = word == "vertex";
      corners_ += is_corner_ ? 1u : 0u;
    } else if (word == "endfacet") {
      if (corners_ != 3) return failure(fmt::format("a facet of {} corners", corners_));
      is_in_facet_ = false;
      return mesh_.add(corner_);
    } else if (word != "outer" && word != "loop" && word != "endloop") {
      return failure(fmt::format("'{}' within a facet", given));
    }
    return {};
  }

  [[nodiscard]] Status failure(std::string_view why) const {
    return Error{Errc::kImportFailed,
                 fmt::format("{}: line {}: {}{}", file_, line_, why, is_last_ ? kAsIfCut : "")};
  }

  std::string_view rest_;
  const std::string& file_;
  StlMesh<T>& mesh_;
  std::size_t line_ = 0;  // current line, from 1
  Tokens words_;
  bool is_last_ = false;    // nothing follows the current word, not even the end of its line
  bool is_open_ = false;    // inside a solid
  bool is_name_ = false;    // the rest of the line is a name
  bool after_end_ = false;  // the previous word was "end"
  bool is_in_facet_ = false;
  bool is_corner_ = false;        // the current numbers are a corner's
  std::size_t numbers_left_ = 0;  // still expected
  std::size_t corners_ = 0;       // of the current facet
  std::array<typename StlMesh<T>::Corner, 3> corner_{};
};

}  // namespace

bool is_text_stl(std::string_view start) {
  const std::string_view shown = start.substr(0, kShown);
  const std::size_t word = shown.find_first_not_of(" \t\r\n");
  return word != std::string_view::npos && begins_with_solid(shown.substr(word)) &&
         shown.find('\0') == std::string_view::npos;
}

template <class T>
Status read_text_stl(std::string_view text, const std::string& file, StlMesh<T>& mesh) {
  return TextStlReader<T>(text, file, mesh).read();
}

template Status read_text_stl(std::string_view, const std::string&, StlMesh<float>&);
template Status read_text_stl(std::string_view, const std::string&, StlMesh<double>&);

}  // namespace boxtree::cooker
