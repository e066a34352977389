// SPDX-License-Identifier: MIT
// What a command declares of itself, once: help, man pages and completions are made of it. Commands
// do not see CLI11, which parses: its templates take three seconds of each source that does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cooker/cli/exit_status.h"

namespace CLI {
class Option;
}  // namespace CLI

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
  kCookedFilesAndMeshes,
  kMeshes,
  kProfiles,
  kFolders,
  kMeshEndings,
  kCommands
};

/// A command line that runs as printed in a folder with bunny.obj, level.gltf, scene.toml and
/// jobs.jsonl, after those before it.
struct Example {
  std::string what;
  std::string line;
};

class Option;

/// What CLI11 does not know of an option.
struct OptionFacts {
  Values values = Values::kOther;
  bool is_needed = false;          // it has to be given ...
  const Option* unless = nullptr;  // ... but where this one is
  bool one_is_needed = false;      // it, or another option of which this is true
};

/// An option or a positional. Functions without a result of their own return the option.
class Option {
 public:
  explicit Option(CLI::Option* parsed) : parsed_(parsed) {}
  Option(const Option&) = delete;
  Option& operator=(const Option&) = delete;

  Option* type_name(const std::string& name);
  Option* group(const std::string& name);
  /// Help shows the value that it has now as the default.
  Option* shows_default();
  /// Says what the value is. That of an option that names files is not the next option.
  Option* takes(Values values);
  Option* required();
  /// Checked by CLI11 after all was parsed, whose required positionals swallow the names of kinds.
  Option* needed(const Option* unless = nullptr);
  /// The usage line shows that one of such options of the command has to be given. The command
  /// checks it.
  Option* one_is_needed();
  Option* excludes(Option* other);
  /// It may only be given with `other`.
  Option* needs(Option* other);
  Option* one_of(const std::vector<std::string>& values);
  /// Of a number, which is any of its type otherwise: what it has to be. `expected` is for
  /// messages, "a length above 0"; help shows `shown`.
  Option* number(const std::string& expected, const std::function<bool(double)>& is_allowed,
                 const std::string& shown = "");
  /// Whole numbers from `low` to `high`, which help shows as `shown`.
  Option* between(int low, int high, const std::string& shown = "");
  /// Finite numbers above 0; `what`: "a length".
  Option* above_zero(const std::string& what);
  /// `fault` says what is wrong with a value, or nothing.
  Option* check(const std::function<std::string(const std::string& value)>& fault,
                const std::string& shown = "");
  /// Called when it is given.
  Option* each(const std::function<void()>& then);

  /// How often it was given.
  [[nodiscard]] std::size_t count() const;
  [[nodiscard]] const OptionFacts& facts() const { return facts_; }
  [[nodiscard]] const CLI::Option* parsed() const { return parsed_; }

 private:
  friend class Command;
  /// Checks numbers before CLI11 converts them, whose errors do not name what was expected.
  template <class T>
  void expect_number();

  CLI::Option* const parsed_;
  OptionFacts facts_;
  std::string expected_;
  std::function<bool(double)> is_allowed_;
};

/// The command as CLI11 has it: cooker/cli/command_app.h.
class CommandApp;

/// Ends options, as POSIX has it: words behind it are operands.
inline constexpr const char* kEndOfOptions = "--";

/// A command, a kind of query, or the program itself.
class Command {
 public:
  /// The program.
  Command(const std::string& name, const std::string& description, const std::string& version);
  Command(const Command&) = delete;
  Command& operator=(const Command&) = delete;
  ~Command();

  /// Parses a command line, with response files (response_file.h), and runs what it calls. The exit
  /// status if there was nothing to run: that of help, which was printed, or of an error.
  std::optional<int> run(int argc, char** argv);

  /// The same of words that are no command line, as those of a file: runs what they call and prints
  /// nothing. What is wrong with them, as usage_fault; nothing if all is well.
  [[nodiscard]] std::string take(const std::vector<std::string>& words);

  /// `description`: the summary and, after line feeds, paragraphs.
  Command& add_command(const std::string& name, const std::string& description);

  [[nodiscard]] const std::string& name() const { return name_; }
  /// Of the program: the words of the command line behind --.
  [[nodiscard]] const std::vector<std::string>& behind_end() const { return behind_end_; }
  /// Words of the command line that name lists without a line, see with_response_files().
  [[nodiscard]] const std::vector<std::string>& empty_lists() const;
  /// The command that contains this one; null for the program.
  [[nodiscard]] const Command* parent() const { return parent_; }
  [[nodiscard]] std::vector<const Command*> commands() const;
  /// Null if there is none of that name.
  [[nodiscard]] const Command* find(const std::string& name) const;

  /// The first line of the description, for lists of commands.
  [[nodiscard]] std::string summary() const;
  /// The paragraphs below it.
  [[nodiscard]] std::vector<std::string> details() const;
  /// What --help prints.
  [[nodiscard]] std::string help() const;

  void example(std::string what, std::string line) {
    examples_.push_back({std::move(what), std::move(line)});
  }
  [[nodiscard]] const std::vector<Example>& examples() const { return examples_; }

  /// `out` gets the value and has to live until the command has run. command.cpp lists the types.
  template <class T>
  Option* add_option(const std::string& name, T& out, const std::string& help);
  /// `parse` takes the value and says what is wrong with it, or nothing.
  Option* add_parsed_option(const std::string& name,
                            const std::function<std::string(const std::string& value)>& parse,
                            const std::string& help);
  Option* add_flag(const std::string& name, bool& out, const std::string& help);
  /// An option or a positional that names files.
  template <class T>
  Option* add_file(const std::string& name, T& out, Values values, const std::string& help) {
    return add_option(name, out, help)->type_name("FILE")->takes(values);
  }

  /// At most one of its commands is given, and takes the options of this one, too.
  void takes_kinds();
  /// When all was parsed.
  void callback(const std::function<void()>& then);
  /// Whether it was given before what its parent needs, as in `query ray FILE`. Then `query pair A
  /// B` would leave B for the parent's FILE.
  [[nodiscard]] bool stands_too_early() const { return stands_too_early_; }
  /// Whether one of its commands was given.
  [[nodiscard]] bool has_parsed_command() const;

  [[nodiscard]] const CommandApp& app() const { return *app_; }
  /// Of an option of CLI11.
  [[nodiscard]] OptionFacts facts(const CLI::Option* option) const;

 private:
  Command(const std::string& name, const std::string& description, Command& parent);
  /// Of the program.
  void set_words(std::vector<std::string> words);
  Option* add(CLI::Option* parsed);
  Option* add_text(CLI::Option* parsed);
  /// Whether the command line has this word.
  [[nodiscard]] bool is_word(const std::string& word) const;

  const std::string name_;
  const std::string description_;
  Command* const parent_;
  std::shared_ptr<CommandApp> app_;
  std::vector<std::unique_ptr<Command>> commands_;
  std::vector<std::unique_ptr<Option>> options_;
  std::vector<Example> examples_;
  bool stands_too_early_ = false;
  std::vector<std::string> words_;  // of the program: the command line
  std::vector<std::string> behind_end_;
  std::vector<std::string> empty_lists_;  // of the program
};

/// Of a callback: `what` is required and was not given.
[[noreturn]] void refuse_without(const std::string& what);

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

/// "-o, --output FILE".
[[nodiscard]] std::string written(const OptionText& option);

[[nodiscard]] std::vector<OptionText> positionals_of(const Command& command);
/// Options of the command alone, common ones first.
[[nodiscard]] std::vector<OptionText> options_of(const Command& command);
/// Whether the command, or one of the program's, may end with that status: only those that audit a
/// cache find differences.
[[nodiscard]] bool can_end_with(const Command& command, const ExitStatus& status);

/// "boxtree query FILE ray": how the command is called.
[[nodiscard]] std::string call_of(const Command& command);
/// " FILE2 [OPTION...]": what follows it.
[[nodiscard]] std::string arguments_of(const Command& command);

/// "boxtree query ray".
[[nodiscard]] std::string name_of(const Command& command);

}  // namespace boxtree::cooker
