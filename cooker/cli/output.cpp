// SPDX-License-Identifier: MIT
// Output conventions of the command line.
#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include <boxtree/cooker/cli/output.h>

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

// Bytes of the character that a text begins with; 0 if it is a control character (C0, DEL or C1;
// but for line feeds, which messages of several lines have) or no UTF-8. Unicode 15, table 3-7.
std::size_t character_bytes(std::string_view text) {
  const auto byte = [&](std::size_t i) -> unsigned {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
  };
  const auto is_between = [](unsigned x, unsigned low, unsigned high) {
    return low <= x && x <= high;
  };
  const unsigned first = byte(0);
  if (first < 0x80) return first == '\n' || is_between(first, 0x20, 0x7e) ? 1 : 0;
  const auto continues = [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i <= to; ++i) {
      if (!is_between(byte(i), 0x80, 0xbf)) return false;
    }
    return true;
  };
  if (first == 0xc2) return is_between(byte(1), 0xa0, 0xbf) ? 2 : 0;
  if (is_between(first, 0xc3, 0xdf)) return continues(1, 1) ? 2 : 0;
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
    if (bytes > 0) {
      printable += text.substr(0, bytes);
    } else {
      printable += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[0]));
    }
    text.remove_prefix(std::max<std::size_t>(bytes, 1));
  }
  return printable;
}

void print(const Json& document) {
  fmt::print("{}\n", document.dump(2, ' ', false, Json::error_handler_t::replace));
}

std::string line_of(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string HelpFormatter::make_help(const CLI::App* app, std::string name,
                                     CLI::AppFormatMode mode) const {
  all_ = mode == CLI::AppFormatMode::All;
  return CLI::Formatter::make_help(app, std::move(name), mode);
}

std::string HelpFormatter::make_group(std::string group, bool is_positional,
                                      std::vector<const CLI::Option*> options) const {
  if (group == kRareOptions && !all_) return {};
  return CLI::Formatter::make_group(std::move(group), is_positional, std::move(options));
}

void VectorOption::add_to(CLI::App& command, const std::string& option, const std::string& help) {
  name = option;
  command
      .add_option_function<std::string>(
          option,
          [this](const std::string& text) {
            if (!parse_vector(text, value)) {
              throw CLI::ValidationError(name, "expected X,Y,Z, found \"" + text + "\"");
            }
            given = true;
          },
          help)
      ->type_name("X,Y,Z");
}

}  // namespace boxtree::cooker
