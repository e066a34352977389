// SPDX-License-Identifier: MIT
// Output conventions of the command line.
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

}  // namespace

int fail(const Error& error) {
  fmt::print(stderr, "boxtree: {}\n", error.message());
  return error_info(error.code).exit_status;
}

int usage(const std::string& what) {
  fmt::print(stderr, "boxtree: {}\n", what);
  return kExitUsage;
}

int fail_to_print() {
  const int error = errno;
  fmt::print(stderr, "boxtree: standard output: {}\n", std::generic_category().message(error));
  return kExitInputOutput;
}

Json to_json(const Eigen::Vector3d& vector) {
  return {vector[0], vector[1], vector[2]};
}

void print(const Json& document) {
  fmt::print("{}\n", document.dump(2, ' ', false, Json::error_handler_t::replace));
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
