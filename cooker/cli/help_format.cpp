// SPDX-License-Identifier: MIT
#include "cooker/cli/help_format.h"

#include <algorithm>
#include <sstream>
#include <utility>

namespace boxtree::cooker {
namespace {

constexpr std::size_t kTextColumn = 28;  // where descriptions begin

// What an option takes: its metavar, and what its checks say of the values.
struct Value {
  std::string metavar;
  std::string choices;
};

Value value_of(const CLI::Option& option) {
  if (option.get_type_size() == 0) return {};
  const std::string type = option.get_type_name();
  const std::size_t colon = type.find(':');
  Value value{type.substr(0, colon), {}};
  if (colon == std::string::npos) return value;
  value.choices = type.substr(colon + 1);
  if (value.choices.front() != '{') return value;
  value.choices = value.choices.substr(1, value.choices.size() - 2);
  for (std::size_t comma = 0; (comma = value.choices.find(',', comma)) != std::string::npos;) {
    value.choices.replace(comma, 1, ", ");
    comma += 2;
  }
  return value;
}

std::string described(const CLI::Option& option, const Value& value) {
  std::string text = option.get_description();
  if (!value.choices.empty()) text += " (" + value.choices + ")";
  if (!option.get_default_str().empty()) text += " [" + option.get_default_str() + "]";
  return text;
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

// " FILE [MESH...]".
std::string positionals_of(const CLI::App& app) {
  std::string line;
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_positional()) continue;
    std::string one = value_of(*option).metavar;
    if (option->get_expected_max() > 1) one += "...";
    line += option->get_required() ? " " + one : " [" + one + "]";
  }
  return line;
}

// "boxtree query FILE ray".
std::string name_of(const CLI::App& app) {
  const CLI::App* parent = app.get_parent();
  if (parent == nullptr) return app.get_name();
  return name_of(*parent) + positionals_of(*parent) + " " + app.get_name();
}

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

// A line of `text` is a paragraph.
std::string paragraphs(const std::string& text) {
  std::string out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) out += wrapped(line, 0, 0) + "\n";
  return out;
}

}  // namespace

std::string wrapped(const std::string& text, std::size_t at, std::size_t indent,
                    std::size_t width) {
  std::string out;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (!out.empty() && at + 1 + word.size() > width) {
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

std::string HelpFormatter::make_help(const CLI::App* app, std::string name,
                                     CLI::AppFormatMode mode) const {
  all_ = mode == CLI::AppFormatMode::All;
  return CLI::Formatter::make_help(app, std::move(name), mode);
}

// Options that must be given are named, so that the line can be taken as it is.
std::string HelpFormatter::make_usage(const CLI::App* app, std::string /*name*/) const {
  const std::string name = name_of(*app);
  std::string line = positionals_of(*app);
  bool has_others = false;
  for (const CLI::Option* option : app->get_options()) {
    if (!option->nonpositional()) continue;
    if (option->get_required()) {
      line += " " + (option->get_snames().empty() ? "--" + option->get_lnames().front()
                                                  : "-" + option->get_snames().front());
      line += " " + value_of(*option).metavar;
    } else {
      has_others = true;
    }
  }
  if (has_others) line += " [OPTION...]";
  if (!app->get_subcommands([](const CLI::App*) { return true; }).empty()) {
    const bool is_command = app->get_parent() == nullptr;
    line += is_command ? " COMMAND ..." : " KIND ...";
  }
  const std::string start = "Usage: " + name;
  return start + " " + wrapped(line, start.size() + 1, 7 + name.size() + 1) + "\n";
}

std::string HelpFormatter::make_group(std::string group, bool is_positional,
                                      std::vector<const CLI::Option*> options) const {
  if (group == kRareOptions && !all_) return {};
  return CLI::Formatter::make_group(std::move(group), is_positional, std::move(options));
}

std::string HelpFormatter::make_option(const CLI::Option* option, bool is_positional) const {
  const Value value = value_of(*option);
  std::string name = is_positional ? value.metavar : option->get_name(false, true);
  if (!is_positional) {
    if (const std::size_t comma = name.find(','); comma != std::string::npos) {
      name.insert(comma + 1, " ");  // "-o, --output FILE"
    }
    if (!value.metavar.empty()) name += " " + value.metavar;
  }
  if (option->get_expected_max() > 1) name += "...";
  return row(name, described(*option, value));
}

std::string HelpFormatter::make_subcommand(const CLI::App* command) const {
  return row(command->get_name(), first_line(command->get_description()));
}

std::string HelpFormatter::make_description(const CLI::App* app) const {
  return paragraphs(app->get_description());
}

std::string HelpFormatter::make_footer(const CLI::App* app) const {
  return paragraphs(app->get_footer());
}

}  // namespace boxtree::cooker
