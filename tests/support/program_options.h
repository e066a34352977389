// SPDX-License-Identifier: MIT
// Options of the programs below tests/. They do not see CLI11, which parses: its templates take ten
// seconds of each source that does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace boxtree::test {

/// One of them. Functions return it again.
class ProgramOption {
 public:
  explicit ProgramOption(CLI::Option* parsed) : parsed_(parsed) {}

  ProgramOption& required();
  ProgramOption& one_of(const std::vector<std::string>& values);
  ProgramOption& between(std::uint64_t low, std::uint64_t high);
  /// Help shows the value that it has now.
  ProgramOption& shows_default();
  /// Of several values: the option is repeated for each, and words behind the first are not its.
  ProgramOption& one_value_each();
  ProgramOption& separated_by(char delimiter);

 private:
  CLI::Option* parsed_;
};

/// Names are those of CLI11: "--json", "-j,--jobs", or "meshes" for a positional. What gets a value
/// must outlive parse().
class ProgramOptions {
 public:
  explicit ProgramOptions(const std::string& description);
  ProgramOptions(const ProgramOptions&) = delete;
  ProgramOptions& operator=(const ProgramOptions&) = delete;
  ~ProgramOptions();

  /// T: std::string, std::filesystem::path, double, int, std::uint32_t, std::uint64_t, that as
  /// std::optional, or vectors of strings, paths or std::uint64_t.
  template <class T>
  ProgramOption add(const std::string& name, T& out, const std::string& help = "");
  ProgramOption add_flag(const std::string& name, bool& out, const std::string& help = "");

  /// The exit status if the program ends here: that of --help, which was printed, or of an error.
  std::optional<int> parse(int argc, const char* const* argv);

 private:
  std::unique_ptr<CLI::App> app_;
};

}  // namespace boxtree::test
