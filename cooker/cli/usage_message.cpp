// SPDX-License-Identifier: MIT
#include "cooker/cli/usage_message.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "cooker/cli/command_app.h"
#include "cooker/cli/output.h"
#include "cooker/text/nearest_name.h"

namespace boxtree::cooker {
namespace {

// The command that was being parsed.
const Command& innermost(const CLI::App& program) {
  const CLI::App* at = &program;
  while (!at->get_subcommands().empty()) at = at->get_subcommands().front();
  return command_of(*at);
}

// A command takes the options of those around it, too.
std::vector<std::string> option_names(const Command& command) {
  std::vector<std::string> names;
  for (const Command* at = &command; at != nullptr; at = at->parent()) {
    for (const CLI::Option* option : at->app().get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
  }
  return names;
}

// The first argument that nobody took, an option if there is one; empty if all were taken.
std::string unexpected(const CLI::App& app) {
  const std::vector<std::string> rest = app.remaining(true);
  const auto option = std::find_if(rest.begin(), rest.end(),
                                   [](const std::string& word) { return word.starts_with('-'); });
  if (option != rest.end()) return option->substr(0, option->find('='));
  return rest.empty() ? std::string() : rest.front();
}

// What was misspelt comes before what is missing because of it.
std::string fault(const CLI::App& app, const Command& command, const CLI::Error& error) {
  const bool is_missing = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
  const bool is_extra = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
  const std::string word = is_missing || is_extra ? unexpected(app) : std::string();
  if (word.starts_with('-')) {
    return "'" + word + "' is no option" + suggestion(word, option_names(command));
  }
  if (!word.empty() && !command.commands().empty()) return unknown_command(command, word);
  if (!word.empty() && is_extra) return "'" + word + "' was not expected";
  return is_missing && app.get_subcommands().empty() ? "a command is required" : error.what();
}

}  // namespace

std::string unknown_command(const Command& command, const std::string& word) {
  std::vector<std::string> names;
  for (const Command* inner : command.commands()) names.push_back(inner->name());
  const std::string kind = command.parent() == nullptr ? "command" : "kind of " + command.name();
  return "'" + word + "' is no " + kind + suggestion(word, names);
}

std::string usage_message(const CLI::App* app, const CLI::Error& error) {
  const Command& command = innermost(*app);
  const std::string name = name_of(command);
  // "boxtree: query ray: --origin is required"
  const std::string place = name.size() > app->get_name().size()
                                ? name.substr(app->get_name().size() + 1) + ": "
                                : std::string();
  return "boxtree: " + place + shown(fault(*app, command, error)) + "\nSee '" + name +
         " --help'.\n";
}

}  // namespace boxtree::cooker
