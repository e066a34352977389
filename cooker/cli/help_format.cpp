// SPDX-License-Identifier: MIT
#include "cooker/cli/help_format.h"

#include <algorithm>
#include <sstream>
#include <utility>
#include <vector>

#include "cooker/cli/exit_status.h"

namespace boxtree::cooker {
namespace {

constexpr std::size_t kTextColumn = 28;  // where descriptions begin
constexpr std::size_t kWidth = 79;

// Breaks text between words so that no line is longer than kWidth, if its words are not; lines
// after the first begin with `indent` blanks. `at`: the column where the text begins.
std::string wrapped(const std::string& text, std::size_t at, std::size_t indent) {
  std::string out;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (!out.empty() && at + 1 + word.size() > kWidth) {
      out += "\n" + std::string(indent, ' ');
      at = indent;
    } else if (!out.empty()) {
      out += ' ';
      ++at;
    }
    out += word;
    at += word.size();
  }
  return out;
}

// Two columns; a long first one has a line of its own.
std::string row(const std::string& name, const std::string& text) {
  std::string line = "  " + name;
  if (line.size() + 2 > kTextColumn) {
    line += "\n" + std::string(kTextColumn, ' ');
  } else {
    line.resize(kTextColumn, ' ');
  }
  return line + wrapped(text, kTextColumn, kTextColumn) + "\n";
}

}  // namespace

std::string HelpFormatter::make_help(const CLI::App* app, std::string name,
                                     CLI::AppFormatMode mode) const {
  if (mode != CLI::AppFormatMode::Sub) all_ = mode == CLI::AppFormatMode::All;
  const CLI::App* const outer = std::exchange(app_, app);
  std::string help = CLI::Formatter::make_help(app, std::move(name), mode);
  app_ = outer;
  // CLI11 has an empty line behind a group, shown or not, and another one before what follows.
  for (std::size_t at = 0; (at = help.find("\n\n\n", at)) != std::string::npos;) help.erase(at, 1);
  return help;
}

std::string HelpFormatter::make_usage(const CLI::App* app, std::string /*name*/) const {
  const auto& command = command_of(*app);
  const std::string start = "Usage: " + call_of(command);
  return start + " " + wrapped(arguments_of(command), start.size() + 1, start.size() + 1) + "\n";
}

std::string HelpFormatter::make_group(std::string group, bool is_positional,
                                      std::vector<const CLI::Option*> options) const {
  if (group == kRareOptions && !all_) return {};
  return CLI::Formatter::make_group(std::move(group), is_positional, std::move(options));
}

std::string HelpFormatter::make_option(const CLI::Option* option, bool /*is_positional*/) const {
  const OptionText text = text_of(command_of(*app_), *option);
  return row(written(text) + (text.repeats ? "..." : ""), text.description);
}

std::string HelpFormatter::make_subcommand(const CLI::App* command) const {
  return row(command->get_name(), command_of(*command).summary());
}

std::string HelpFormatter::make_description(const CLI::App* app) const {
  const auto& command = command_of(*app);
  std::string text = wrapped(command.summary(), 0, 0) + "\n";
  for (const std::string& paragraph : command.details()) text += wrapped(paragraph, 0, 0) + "\n";
  return text;
}

std::string HelpFormatter::make_footer(const CLI::App* app) const {
  const auto& command = command_of(*app);
  std::string footer;
  if (!command.examples().empty()) footer += "Examples:\n";
  for (const Example& example : command.examples()) footer += "  " + example.line + "\n";
  if (!command.examples().empty()) footer += "\n";
  std::string statuses;
  for (const ExitStatus& status : kExitStatuses) {
    if (!can_end_with(command, status)) continue;
    statuses += (statuses.empty() ? "" : ", ") + std::to_string(status.number) + " " + status.name;
  }
  footer += wrapped("Exit status: " + statuses + ".", 0, 0) + "\n";
  const std::vector<OptionText> options = options_of(command);
  const bool has_more = std::any_of(options.begin(), options.end(),
                                    [](const OptionText& option) { return option.is_rare; });
  if (has_more && !all_) footer += "More options: " + name_of(command) + " " + kHelpAllFlag + "\n";
  return footer;
}

}  // namespace boxtree::cooker
