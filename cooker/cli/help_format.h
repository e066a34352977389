// SPDX-License-Identifier: MIT
// How --help looks: a usage line, then options with what they take and what they do, within 79
// columns. Common options first; --help-all shows the rest too, in the manner of zstd.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace boxtree::cooker {

/// Group of options that `--help` leaves to `--help-all`.
inline constexpr const char* kRareOptions = "Rarely needed";

/// A command's description is a line for the list of commands, and paragraphs for its own help.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
  std::string make_usage(const CLI::App* app, std::string name) const override;
  std::string make_group(std::string group, bool is_positional,
                         std::vector<const CLI::Option*> options) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_subcommand(const CLI::App* command) const override;
  std::string make_description(const CLI::App* app) const override;
  std::string make_footer(const CLI::App* app) const override;

 private:
  mutable bool all_ = false;  // make_group is not told the mode
};

/// Breaks text between words so that no line is longer than `width`, if its words are not; lines
/// after the first begin with `indent` blanks. `at`: the column where the text begins.
[[nodiscard]] std::string wrapped(const std::string& text, std::size_t at, std::size_t indent,
                                  std::size_t width = 79);

}  // namespace boxtree::cooker
