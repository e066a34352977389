// SPDX-License-Identifier: MIT
// Inserts numbers into the text of an error.
#include "format/message.h"

#include <string>

namespace boxtree {

namespace {

// Appends `text`, each '#' replaced by the next number; without numbers, as it is.
void append(std::string& detail, std::string_view text, const std::uint64_t* number = nullptr) {
  for (const char c : text) {
    if (c == '#' && number != nullptr) {
      detail += std::to_string(*number++);
    } else {
      detail += c;
    }
  }
}

}  // namespace

Error error_with(Errc code, std::string_view place, std::string_view text,
                 std::initializer_list<std::uint64_t> numbers) {
  Error error{code, {}};
  append(error.detail, place);
  append(error.detail, text, numbers.size() > 0 ? numbers.begin() : nullptr);
  return error;
}

Error error_at(std::string_view place, const Error& error) {
  Error placed{error.code, {}};
  append(placed.detail, place);
  append(placed.detail, error.detail);
  return placed;
}

Error error_in(std::string_view place, const Error& error) {
  return error_at(error_with(error.code, place, ": ").detail, error);
}

Error error_of(std::string_view what, std::uint64_t number, const Error& error) {
  return error_at(error_with(error.code, what, " #: ", {number}).detail, error);
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
