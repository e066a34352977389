// SPDX-License-Identifier: MIT
// Inserts numbers into the text of an error.
#include "format/message.h"

#include <string>
#include <utility>

namespace boxtree {

Error error_with(Errc code, std::string_view place, std::string_view text,
                 std::initializer_list<std::uint64_t> numbers) {
  std::string detail(place);
  const std::uint64_t* number = numbers.begin();
  for (const char c : text) {
    if (c == '#') {
      detail += std::to_string(*number++);
    } else {
      detail += c;
    }
  }
  return {code, std::move(detail)};
}

Error index_error(Errc code, std::string_view what, std::uint64_t index, std::uint64_t count) {
  Error error = error_with(code, "there is no ", what);
  const std::string_view expected = count == 0   ? " #, nor any other"
                                    : count == 1 ? " #; expected 0"
                                    : count == 2 ? " #; expected 0 or 1"
                                                 : " #; expected 0 to #";
  error.detail = error_with(code, error.detail, expected, {index, count - 1}).detail;
  return error;
}

Error section_size_error(std::uint64_t found, std::uint64_t expected) {
  return error_with(Errc::kSectionSize, {}, "# bytes, its record states #", {found, expected});
}

}  // namespace boxtree
