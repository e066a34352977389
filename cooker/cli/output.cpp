// SPDX-License-Identifier: MIT
// Output conventions of the command line.
#include "cooker/cli/output.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "cooker/text/utf8.h"

namespace boxtree::cooker {
namespace {

bool parse_vector(const std::string& text, Eigen::Vector3d& out) {
  const char* at = text.data();
  const char* const end = at + text.size();
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (i > 0 && (at == end || *at++ != ',')) return false;
    const auto [next, error] = std::from_chars(at, end, out[i]);  // locale-independent
    if (error != std::errc()) return false;
    at = next;
  }
  return at == end;
}

// A character that a terminal shows: no control character (C0, DEL or C1) but for line feeds, which
// messages of several lines have.
bool is_shown(std::string_view character) {
  const auto first = static_cast<unsigned char>(character[0]);
  if (first < 0x80) return first == '\n' || (0x20 <= first && first <= 0x7e);
  return first != 0xc2 || static_cast<unsigned char>(character[1]) >= 0xa0;
}

}  // namespace

// Where standard error takes nothing either, the exit status has to say it all: fmt would throw.
void complain(std::string_view what) noexcept {
  const std::string line = "boxtree: " + shown(what) + "\n";
  static_cast<void>(std::fputs(line.c_str(), stderr));
}

int fail(const Error& error) {
  complain(error.message());
  return error_info(error.code).exit_status;
}

int usage(const std::string& what) {
  complain(what);
  return kExitUsage;
}

int fail_to_print() {
  const int error = errno;
  complain("standard output: " + std::generic_category().message(error));
  return kExitInputOutput;
}

Json to_json(const Eigen::Vector3d& vector) {
  return {vector[0], vector[1], vector[2]};
}

std::string shown(std::string_view text) {
  std::string printable;
  while (!text.empty()) {
    const std::size_t bytes = character_bytes(text);
    if (bytes > 0 && is_shown(text)) {
      printable += text.substr(0, bytes);
    } else {
      for (const char c : text.substr(0, std::max<std::size_t>(bytes, 1))) {
        printable += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
      }
    }
    text.remove_prefix(std::max<std::size_t>(bytes, 1));
  }
  return printable;
}

std::string document_text(const Json& document) {
  constexpr int kSchema = 1;
  Json whole = {{"schema", kSchema}};
  whole.update(document);
  return whole.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void print(const Json& document) {
  fmt::print("{}", document_text(document));
}

void print_files(std::vector<Json> documents) {
  if (documents.size() == 1) return print(documents.front());
  print(Json{{"files", std::move(documents)}});
}

std::string line_of(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

CLI::Option* add_vector_option(CLI::App& command, const std::string& option, Eigen::Vector3d& out,
                               const std::string& help) {
  return command
      .add_option_function<std::string>(
          option,
          [option, &out](const std::string& text) {
            if (!parse_vector(text, out)) {
              throw CLI::ValidationError(option, "expected X,Y,Z, found \"" + text + "\"");
            }
          },
          help)
      ->type_name("X,Y,Z");
}

}  // namespace boxtree::cooker
