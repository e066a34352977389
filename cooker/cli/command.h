// SPDX-License-Identifier: MIT
// What a command declares of itself, once: help, man pages and completions are made of it.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace boxtree::cooker {

/// Group of options that `--help` leaves to `--help-all`.
inline constexpr const char* kRareOptions = "Rarely needed";

/// Shows rare options, too. Every command has it.
inline constexpr const char* kHelpAllFlag = "--help-all";

/// What a value is, where its option does not list all there are: for completions.
enum class Values : std::uint8_t {
  kOther,
  kFiles,
  kCookedFiles,
  kMeshes,
  kProfiles,
  kFolders,
  kMeshEndings,
  kCommands
};

/// A command line that runs as printed in a folder with bunny.obj, level.gltf and scene.toml, after
/// those before it.
struct Example {
  std::string what;
  std::string line;
};

/// What CLI11 does not know of an option.
struct OptionFacts {
  Values values = Values::kOther;
  bool is_needed = false;               // it has to be given ...
  const CLI::Option* unless = nullptr;  // ... but where this one is
};

/// A command, a kind of query, or the program itself.
class Command : public CLI::App {
 public:
  Command(const std::string& name, const std::string& description) : CLI::App(description, name) {}

  /// `description`: the summary and, after line feeds, paragraphs.
  Command& add_command(const std::string& name, const std::string& description);

  /// The command that contains this one; null for the program.
  [[nodiscard]] const Command* parent() const;
  [[nodiscard]] std::vector<const Command*> commands() const;
  /// Null if there is none of that name.
  [[nodiscard]] const Command* find(const std::string& name) const;

  /// The first line of the description, for lists of commands.
  [[nodiscard]] std::string summary() const;
  /// The paragraphs below it.
  [[nodiscard]] std::vector<std::string> details() const;

  void example(std::string what, std::string line) {
    examples_.push_back({std::move(what), std::move(line)});
  }
  [[nodiscard]] const std::vector<Example>& examples() const { return examples_; }

  /// An option or a positional that names files.
  template <class T>
  CLI::Option* add_file(const std::string& name, T& out, Values values, const std::string& help) {
    return takes(add_option(name, out, help)->type_name("FILE"), values);
  }
  /// Says what the value of an option is. Returns `option`, as does is_needed.
  CLI::Option* takes(CLI::Option* option, Values values);
  /// Checked by check_needed, not by CLI11, whose required positionals swallow the names of kinds.
  CLI::Option* is_needed(CLI::Option* option, const CLI::Option* unless = nullptr);

  [[nodiscard]] OptionFacts facts(const CLI::Option* option) const;

 private:
  Command(const std::string& name, const std::string& description, Command& parent)
      : CLI::App(description, name, &parent) {}

  std::vector<Example> examples_;
  std::map<const CLI::Option*, OptionFacts> facts_;
};

/// Whether the commands that were parsed have all that they need. Throws CLI::RequiredError.
void check_needed(const Command& program);

/// An option as help, man pages and completions show it.
struct OptionText {
  std::vector<std::string> names;    // "-o", "--output"; none for a positional
  std::string metavar;               // "FILE"; empty for a flag
  std::vector<std::string> choices;  // all values there are, if they are listed
  std::string description;           // with range and default
  bool is_needed = false;
  bool repeats = false;
  bool is_rare = false;
  OptionFacts facts;
};

[[nodiscard]] OptionText text_of(const Command& command, const CLI::Option& option);
[[nodiscard]] std::vector<OptionText> positionals_of(const Command& command);
/// Options of the command alone, common ones first.
[[nodiscard]] std::vector<OptionText> options_of(const Command& command);

/// "boxtree query FILE ray": how the command is called.
[[nodiscard]] std::string call_of(const Command& command);
/// " FILE2 [OPTION...]": what follows it.
[[nodiscard]] std::string arguments_of(const Command& command);

/// "boxtree query ray".
[[nodiscard]] std::string name_of(const Command& command);

}  // namespace boxtree::cooker
