// SPDX-License-Identifier: MIT
#include "cooker/cli/command.h"

#include <algorithm>
#include <sstream>
#include <utility>

namespace boxtree::cooker {
namespace {

// All are Commands, as Command::add_command alone adds them.
const Command& as_command(const CLI::App& app) {
  return static_cast<const Command&>(app);
}

std::vector<std::string> split_list(const std::string& text) {
  std::vector<std::string> words(1);
  for (const char c : text) {
    if (c == ',') {
      words.emplace_back();
    } else {
      words.back() += c;
    }
  }
  return words;
}

// "FILE" for a positional, "--output" for an option.
std::string shown_name(const CLI::Option& option) {
  return option.get_positional() ? option.get_name(true) : option.get_name();
}

// The program and the commands that were parsed, from the outermost to the innermost.
std::vector<const Command*> parsed_commands(const Command& program) {
  std::vector<const Command*> chain{&program};
  while (!chain.back()->get_subcommands().empty()) {
    chain.push_back(&as_command(*chain.back()->get_subcommands().front()));
  }
  return chain;
}

}  // namespace

Command& Command::add_command(const std::string& name, const std::string& description) {
  const std::shared_ptr<Command> command(new Command(name, description, *this));
  command->set_help_all_flag(kHelpAllFlag, "Print every option");
  add_subcommand(command);
  return *command;
}

const Command* Command::parent() const {
  return get_parent() == nullptr ? nullptr : &as_command(*get_parent());
}

std::vector<const Command*> Command::commands() const {
  std::vector<const Command*> commands;
  for (const CLI::App* app : get_subcommands([](const CLI::App*) { return true; })) {
    commands.push_back(&as_command(*app));
  }
  return commands;
}

const Command* Command::find(const std::string& name) const {
  for (const Command* command : commands()) {
    if (command->get_name() == name) return command;
  }
  return nullptr;
}

std::string Command::summary() const {
  const std::string description = get_description();
  return description.substr(0, description.find('\n'));
}

std::vector<std::string> Command::details() const {
  std::istringstream lines(get_description());
  std::vector<std::string> paragraphs;
  for (std::string line; std::getline(lines, line);) paragraphs.push_back(line);
  if (!paragraphs.empty()) paragraphs.erase(paragraphs.begin());
  return paragraphs;
}

CLI::Option* Command::takes(CLI::Option* option, Values values) {
  facts_[option].values = values;
  return option;
}

CLI::Option* Command::is_needed(CLI::Option* option, const CLI::Option* unless) {
  facts_[option].is_needed = true;
  facts_[option].unless = unless;
  return option;
}

OptionFacts Command::facts(const CLI::Option* option) const {
  const auto found = facts_.find(option);
  return found == facts_.end() ? OptionFacts() : found->second;
}

void check_needed(const Command& program) {
  for (const Command* command : parsed_commands(program)) {
    for (const CLI::Option* option : command->get_options()) {
      const OptionFacts facts = command->facts(option);
      const bool is_excused = facts.unless != nullptr && facts.unless->count() > 0;
      if (facts.is_needed && option->count() == 0 && !is_excused) {
        throw CLI::RequiredError(shown_name(*option));
      }
    }
  }
}

OptionText text_of(const Command& command, const CLI::Option& option) {
  OptionText text;
  text.facts = command.facts(&option);
  text.description = option.get_description();
  text.is_needed = text.facts.is_needed || option.get_required();
  text.repeats = option.get_expected_max() > 1;
  text.is_rare = option.get_group() == kRareOptions;
  if (!option.get_positional()) {
    for (const std::string& name : option.get_snames()) text.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) text.names.push_back("--" + name);
  }
  if (option.get_type_size() == 0) return text;
  // "NAME:{one,two}", or the range of numbers in words.
  const std::string type = option.get_type_name();
  const std::size_t colon = type.find(':');
  text.metavar = option.get_positional() ? option.get_name(true) : type.substr(0, colon);
  std::string values = colon == std::string::npos ? std::string() : type.substr(colon + 1);
  if (values.starts_with('{')) {
    text.choices = split_list(values.substr(1, values.size() - 2));
    values.clear();
    for (const std::string& choice : text.choices) {
      values += (values.empty() ? "" : ", ") + choice;
    }
  }
  if (!values.empty()) text.description += " (" + values + ")";
  if (!option.get_default_str().empty()) text.description += " [" + option.get_default_str() + "]";
  return text;
}

std::vector<OptionText> positionals_of(const Command& command) {
  std::vector<OptionText> texts;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_positional()) texts.push_back(text_of(command, *option));
  }
  return texts;
}

std::vector<OptionText> options_of(const Command& command) {
  std::vector<OptionText> texts;
  for (const CLI::Option* option : command.get_options()) {
    if (option->nonpositional()) texts.push_back(text_of(command, *option));
  }
  std::stable_partition(texts.begin(), texts.end(),
                        [](const OptionText& text) { return !text.is_rare; });
  return texts;
}

std::string call_of(const Command& command) {
  const Command* const parent = command.parent();
  if (parent == nullptr) return command.get_name();
  std::string call = call_of(*parent);
  for (const OptionText& positional : positionals_of(*parent)) call += " " + positional.metavar;
  return call + " " + command.get_name();
}

// Options that must be given are named, so that the line can be taken as it is.
std::string arguments_of(const Command& command) {
  std::string line;
  for (const OptionText& positional : positionals_of(command)) {
    const std::string one = positional.metavar + (positional.repeats ? "..." : "");
    line += positional.is_needed ? " " + one : " [" + one + "]";
  }
  bool has_others = false;
  for (const OptionText& option : options_of(command)) {
    if (option.is_needed) {
      line += " " + option.names.front() + " " + option.metavar;
    } else {
      has_others = true;
    }
  }
  if (has_others) line += " [OPTION...]";
  if (!command.commands().empty()) {
    line += command.parent() == nullptr ? " COMMAND ..." : " KIND ...";
  }
  return line;
}

std::string name_of(const Command& command) {
  const Command* const parent = command.parent();
  return parent == nullptr ? command.get_name() : name_of(*parent) + " " + command.get_name();
}

}  // namespace boxtree::cooker
