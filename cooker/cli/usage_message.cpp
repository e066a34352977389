// SPDX-License-Identifier: MIT
#include "cooker/cli/usage_message.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "cooker/cli/command_app.h"
#include "cooker/cli/output.h"
#include "cooker/import/import.h"
#include "cooker/system/path.h"
#include "cooker/text/nearest_name.h"

namespace boxtree::cooker {
namespace {

// The command that was being parsed.
const Command& innermost(const CLI::App& program) {
  const CLI::App* at = &program;
  while (!at->get_subcommands().empty()) at = at->get_subcommands().front();
  return command_of(*at);
}

// What other programs call commands and options of ours; both in one list, since options begin
// with "--".
constexpr Synonym kSynonyms[] = {
    {"build", "cook"},       {"convert", "cook"},    {"check", "verify"},
    {"validate", "verify"},  {"list", "info"},       {"show", "info"},
    {"dump", "export"},      {"hash", "key"},        {"closest", "point"},
    {"nearest", "point"},    {"sweep", "cast"},      {"--from", "--origin"},
    {"--start", "--origin"}, {"--position", "--at"}, {"--position", "--center"},
    {"--threads", "--jobs"}, {"--low", "--min"},     {"--high", "--max"},
};

std::vector<std::string> command_names(const Command& command) {
  std::vector<std::string> names;
  for (const Command* inner : command.commands()) names.push_back(inner->name());
  return names;
}

// A kind of query takes the options of those around it, too, a command none of the program.
std::vector<std::string> option_names(const Command& command) {
  std::vector<std::string> names;
  for (const Command* at = &command; at != nullptr; at = at->parent()) {
    if (at->parent() == nullptr && command.parent() == at) break;
    for (const CLI::Option* option : at->app().get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
  }
  return names;
}

// What a command calls the commands below it.
std::string below(const Command& command) {
  return command.parent() == nullptr ? "command" : "kind of " + command.name();
}

bool is_option(const std::string& word) {
  return word.size() > 1 && word.front() == '-';
}

std::string without_value(const std::string& option) {
  return option.substr(0, option.find('='));
}

// The values of positionals, in order.
std::vector<std::string> operands(const Command& command) {
  std::vector<std::string> words;
  for (const CLI::Option* option : command.app().get_options()) {
    if (!option->get_positional()) continue;
    words.insert(words.end(), option->results().begin(), option->results().end());
  }
  return words;
}

// Where a command or a kind of query should be and none was recognised: the word that was probably
// meant to be one, whatever options follow it. `rest`: what nobody took, in order. The name of the
// file may have been put behind the kind, so that it is the kind that was taken for it.
std::string misspelt_command(const Command& command, const std::vector<std::string>& rest) {
  std::vector<std::string> words = operands(command);
  const auto first_option = std::find_if(rest.begin(), rest.end(), is_option);
  words.insert(words.end(), rest.begin(), first_option);
  const std::vector<std::string> names = command_names(command);
  for (const std::string& word : words) {
    if (!suggestion(word, names).empty()) return word;
  }
  return rest.empty() || is_option(rest.front()) ? std::string() : rest.front();
}

bool has_option(const Command& command, const std::string& name) {
  const std::vector<OptionText> options = options_of(command);
  return std::any_of(options.begin(), options.end(), [&](const OptionText& option) {
    return std::find(option.names.begin(), option.names.end(), name) != option.names.end();
  });
}

// "boxtree help query ray".
std::string help_of(const Command& command) {
  return command.parent() == nullptr ? command.name() + " help"
                                     : help_of(*command.parent()) + " " + command.name();
}

// The help of each command below that has the option.
void add_owners(const Command& command, const std::string& option,
                std::vector<std::string>& owners) {
  for (const Command* inner : command.commands()) {
    if (has_option(*inner, option)) owners.push_back("'" + help_of(*inner) + "'");
    add_owners(*inner, option, owners);
  }
}

// "; did you mean '--output'?" of "--outptu" or "--out", the beginning of one option alone; empty
// if nothing is near.
std::string meant_option(const std::string& word, const std::vector<std::string>& names) {
  std::vector<std::string> longer;
  std::copy_if(names.begin(), names.end(), std::back_inserter(longer),
               [&](const std::string& name) { return name.starts_with(word); });
  return longer.size() == 1 ? "; did you mean '" + longer.front() + "'?"
                            : suggestion(word, names, kSynonyms);
}

// An option that nobody took.
std::string unknown_option(const Command& command, const std::string& word) {
  const std::string start = "'" + word + "' is ";
  // Those of `query` may also stand behind its kinds.
  for (const Command* at = &command; at->parent() != nullptr; at = at->parent()) {
    if (has_option(*at, word)) return start + "an option that comes after " + at->name();
  }
  std::vector<std::string> owners;
  for (const Command* inner : command.commands()) {
    if (has_option(*inner, word)) owners.push_back(inner->name());
  }
  if (!owners.empty()) return start + "an option of " + listed(owners) + ", which comes before it";
  const Command* program = &command;
  while (program->parent() != nullptr) program = program->parent();
  const std::string& name = program->name();
  if (has_option(*program, word)) {
    return start + "an option of " + name + " alone; use '" + name + " " + word + "'";
  }
  if (std::error_code ignored;
      word.substr(0, 2) != "--" && std::filesystem::exists(named_path(word), ignored)) {
    return start + "no option; a file of that name is ./" + word;
  }
  const std::string meant = meant_option(word, option_names(command));
  if (!meant.empty() || command.parent() == nullptr) return start + "no option" + meant;
  for (const Command* other : command.parent()->commands()) {
    if (has_option(*other, word)) owners.push_back(other->name());
  }
  if (owners.empty()) return start + "no option";
  return start + "no option of " + command.name() + ", but of " + listed(owners);
}

// What CLI11 says of an option that has too few values or is there too often, by counts: "--at: 1
// required X,Y,Z missing", "--at: At Most 1 required but received 2"; and of a flag with a value.
std::string mismatch(const std::string& said) {
  constexpr std::string_view kMissing = ": 1 required ";
  constexpr std::string_view kOfFlag = "Could not convert: ";  // "... --exact = maybe"
  if (said.starts_with(kOfFlag)) {
    const std::string flag = said.substr(kOfFlag.size());
    const std::size_t equals = flag.find(" = ");
    return flag.substr(0, equals) + ": expected no value, found \"" + flag.substr(equals + 3) +
           "\"";
  }
  constexpr std::string_view kRepeated = ": At Most 1 required but received ";
  if (const std::size_t at = said.find(kMissing); at != std::string::npos) {
    const std::size_t type = at + kMissing.size();
    return said.substr(0, at) + ": expected " +
           said.substr(type, said.find_first_of(": ", type) - type) + ", found no value";
  }
  if (const std::size_t at = said.find(kRepeated); at != std::string::npos) {
    return said.substr(0, at) + ": expected once, found " + said.substr(at + kRepeated.size()) +
           " times";
  }
  const bool is_of_profile =
      said.starts_with("--profile excludes ") || said.ends_with(" excludes --profile");
  return is_of_profile ? said + ": the profile says it, by a key" : said;
}

// What was probably meant to be the value of --output, which is missing: an input that is no mesh,
// or a word that nobody took; empty if there is none.
std::string meant_output(const Command& command, const std::vector<std::string>& rest) {
  if (!rest.empty()) return is_option(rest.back()) ? std::string() : rest.back();
  const std::vector<std::string> inputs = operands(command);
  if (inputs.size() < 2) return {};
  const std::string ending = named_path(inputs.back()).extension().string();
  return ending.empty() || is_mesh_ending(ending.substr(1)) ? std::string() : inputs.back();
}

// "--output is required" as "-o, --output FILE is required", which can be typed.
std::string missing_in_full(const Command& command, const std::string& what) {
  constexpr std::string_view kIsRequired = " is required";
  for (const OptionText& option : options_of(command)) {
    if (!option.names.empty() && what == option.names.back() + std::string(kIsRequired)) {
      return written(option) + std::string(kIsRequired);
    }
  }
  return what;
}

// What is missing.
std::string missing(const Command& command, const std::vector<std::string>& rest,
                    const CLI::Error& error) {
  const std::string what = missing_in_full(command, error.what());
  if (!what.starts_with("-o, --output ")) return what;
  const std::string output = meant_output(command, rest);
  return output.empty() ? what : what + "; did you mean -o " + output + "?";
}

// Of a line with --, behind which all words are operands; empty if that is not the fault.
std::string fault_behind_end(const Command& command, const std::vector<std::string>& behind,
                             const std::vector<std::string>& rest, const std::string& missing) {
  const auto extra = std::find_first_of(behind.begin(), behind.end(), rest.begin(), rest.end());
  if (extra != behind.end()) {
    return "'" + *extra + "' was not expected behind --, where no option" +
           (command.commands().empty() ? "" : " and no " + below(command)) + " stands";
  }
  const bool has_option = std::any_of(behind.begin(), behind.end(), is_option);
  return missing.empty() || !has_option ? std::string()
                                        : missing + "; options come before --, which ends them";
}

// A word that no place is for; an option without its dashes is told by its name.
std::string unexpected_word(const Command& command, const std::string& word) {
  const std::string option = "--" + word;
  return "'" + word + "' was not expected" +
         (has_option(command, option) ? "; did you mean '" + option + "'?" : std::string());
}

// What was misspelt comes before what is missing because of it.
std::string fault(const CLI::App& app, const Command& command, const CLI::Error& error) {
  const bool is_missing = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
  const bool is_extra = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
  std::vector<std::string> rest = app.remaining(true);
  std::erase(rest, kEndOfOptions);
  const auto option = std::find_if(rest.begin(), rest.end(), is_option);
  // The word behind it may have been taken for what excludes the rest.
  if (dynamic_cast<const CLI::ExcludesError*>(&error) != nullptr && option != rest.end()) {
    return unknown_option(command, without_value(*option));
  }
  if (!is_missing && !is_extra) return mismatch(error.what());
  const std::string behind_end =
      fault_behind_end(command, command_of(app).behind_end(), rest,
                       is_missing ? missing_in_full(command, error.what()) : std::string());
  if (!behind_end.empty()) return behind_end;
  if (!rest.empty() && !command.commands().empty()) {
    const std::string word = misspelt_command(command, rest);
    if (!word.empty()) return unknown_command(command, word);
  }
  if (option != rest.end()) return unknown_option(command, without_value(*option));
  if (is_extra) return unexpected_word(command, rest.front());
  return app.get_subcommands().empty() ? "a command is required" : missing(command, rest, error);
}

// A file in the place of a command: what is most likely wanted of it; empty of other words.
std::string command_for(const std::string& word) {
  const std::filesystem::path file = named_path(word);
  const std::string ending = file.extension().string();
  if (ending == ".bxt") return "boxtree info " + word;
  if (ending.empty() || !is_mesh_ending(ending.substr(1))) return {};
  return "boxtree cook " + word + " -o " + file.stem().string() + ".bxt";
}

// "; did you mean 'ray'?" of "raycast", which is too long to be near any name.
std::string part_that_is_one(const std::string& word, const std::vector<std::string>& names) {
  const auto part = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
    return word.find(name) != std::string::npos;
  });
  return part == names.end() ? std::string() : "; did you mean '" + *part + "'?";
}

}  // namespace

std::string unknown_command(const Command& command, const std::string& word) {
  const std::string start = "'" + word + "' is no " + below(command);
  const std::string file = command.parent() == nullptr ? command_for(word) : std::string();
  if (!file.empty()) return start + "; did you mean '" + file + "'?";
  for (const Command* inner : command.commands()) {
    if (const Command* const kind = inner->find(word)) {
      return start + " but a " + below(*inner) + "; see '" + help_of(*kind) + "'";
    }
  }
  const std::vector<std::string> names = command_names(command);
  const std::string similar = suggestion(word, names, kSynonyms);
  if (!similar.empty()) return start + similar;
  std::vector<std::string> owners;
  add_owners(command, "--" + word, owners);
  if (!owners.empty()) return start + " but an option; see " + listed(owners);
  return start + "; expected " + listed(names) + part_that_is_one(word, names);
}

std::string usage_fault(const CLI::App* app, const CLI::Error& error) {
  const Command& command = innermost(*app);
  const std::string name = name_of(command);
  // "query ray: --origin is required"
  const std::string place = name.size() > app->get_name().size()
                                ? name.substr(app->get_name().size() + 1) + ": "
                                : std::string();
  std::string text = place + fault(*app, command, error);
  const bool is_missing = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
  if (is_missing && !command.empty_lists().empty()) {
    text += "; the list " + command.empty_lists().front() + " has no line";
  }
  return text;
}

std::string usage_message(const CLI::App* app, const CLI::Error& error) {
  return "boxtree: usage: " + shown(usage_fault(app, error)) + "\nSee '" +
         name_of(innermost(*app)) + " --help'.\n";
}

}  // namespace boxtree::cooker
