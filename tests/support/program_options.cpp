// SPDX-License-Identifier: MIT
#include "tests/support/program_options.h"

#include <CLI/CLI.hpp>

namespace boxtree::test {

ProgramOption& ProgramOption::required() {
  parsed_->required();
  return *this;
}

ProgramOption& ProgramOption::one_of(const std::vector<std::string>& values) {
  parsed_->check(CLI::IsMember(values));
  return *this;
}

ProgramOption& ProgramOption::between(std::uint64_t low, std::uint64_t high) {
  parsed_->check(CLI::Range(low, high));
  return *this;
}

ProgramOption& ProgramOption::shows_default() {
  parsed_->capture_default_str();
  return *this;
}

ProgramOption& ProgramOption::one_value_each() {
  parsed_->allow_extra_args(false);
  return *this;
}

ProgramOption& ProgramOption::separated_by(char delimiter) {
  parsed_->delimiter(delimiter);
  return *this;
}

ProgramOptions::ProgramOptions(const std::string& description)
    : app_(std::make_unique<CLI::App>(description)) {}

ProgramOptions::~ProgramOptions() = default;

template <class T>
ProgramOption ProgramOptions::add(const std::string& name, T& out, const std::string& help) {
  return ProgramOption(app_->add_option(name, out, help));
}

template ProgramOption ProgramOptions::add(const std::string&, std::string&, const std::string&);
template ProgramOption ProgramOptions::add(const std::string&, std::filesystem::path&,
                                           const std::string&);
template ProgramOption ProgramOptions::add(const std::string&, double&, const std::string&);
template ProgramOption ProgramOptions::add(const std::string&, int&, const std::string&);
template ProgramOption ProgramOptions::add(const std::string&, std::uint32_t&, const std::string&);
template ProgramOption ProgramOptions::add(const std::string&, std::uint64_t&, const std::string&);
template ProgramOption ProgramOptions::add(const std::string&, std::optional<std::uint64_t>&,
                                           const std::string&);
template ProgramOption ProgramOptions::add(const std::string&, std::vector<std::string>&,
                                           const std::string&);
template ProgramOption ProgramOptions::add(const std::string&, std::vector<std::filesystem::path>&,
                                           const std::string&);
template ProgramOption ProgramOptions::add(const std::string&, std::vector<std::uint64_t>&,
                                           const std::string&);

ProgramOption ProgramOptions::add_flag(const std::string& name, bool& out,
                                       const std::string& help) {
  return ProgramOption(app_->add_flag(name, out, help));
}

std::optional<int> ProgramOptions::parse(int argc, const char* const* argv) {
  try {
    app_->parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app_->exit(error);
  }
  return std::nullopt;
}

}  // namespace boxtree::test
