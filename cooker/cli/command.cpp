// SPDX-License-Identifier: MIT
#include "cooker/cli/command.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <sstream>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "cooker/cli/command_app.h"
#include "cooker/cli/exit_status.h"
#include "cooker/cli/help_format.h"
#include "cooker/cli/output.h"
#include "cooker/cli/response_file.h"
#include "cooker/cli/usage_message.h"
#include "cooker/system/path.h"
#include "cooker/text/nearest_name.h"
#include "cooker/text/number_of.h"

namespace boxtree::cooker {
namespace {

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

bool names_files(Values values) {
  return values != Values::kOther && values != Values::kMeshEndings && values != Values::kCommands;
}

// What is wrong with the value of an option that names files. CLI11 takes whatever follows it,
// which is the next option where a script has no name.
std::string file_fault(const CLI::Option& option, const std::string& file) {
  if (!file.starts_with('-') || file == "-") return {};
  return fmt::format("expected {0}, found the option {1}; a file of that name is ./{1}",
                     option.get_type_name(), file);
}

// The program and the commands that were parsed, from the outermost to the innermost.
std::vector<const Command*> parsed_commands(const Command& program) {
  std::vector<const Command*> chain{&program};
  while (chain.back()->has_parsed_command()) {
    chain.push_back(&command_of(*chain.back()->app().get_subcommands().front()));
  }
  return chain;
}

// Whether the commands that were parsed have all that they need.
void check_needed(const Command& program) {
  for (const Command* command : parsed_commands(program)) {
    if (command->stands_too_early()) {
      throw CLI::ArgumentMismatch(fmt::format("{} comes before {}, as in {}",
                                              positionals_of(*command->parent()).front().metavar,
                                              command->name(), call_of(*command)));
    }
    for (const CLI::Option* option : command->app().get_options()) {
      const OptionFacts facts = command->facts(option);
      const bool is_excused = facts.unless != nullptr && facts.unless->count() > 0;
      if (facts.is_needed && option->count() == 0 && !is_excused) {
        throw CLI::RequiredError(shown_name(*option));
      }
    }
  }
}

}  // namespace

Option* Option::type_name(const std::string& name) {
  parsed_->type_name(name);
  return this;
}

Option* Option::group(const std::string& name) {
  parsed_->group(name);
  return this;
}

Option* Option::shows_default() {
  parsed_->capture_default_str();
  return this;
}

Option* Option::takes(Values values) {
  facts_.values = values;
  if (names_files(values) && !parsed_->get_positional()) {
    parsed_->check(
        [parsed = parsed_](const std::string& file) { return file_fault(*parsed, file); }, "");
  }
  return this;
}

Option* Option::required() {
  parsed_->required();
  return this;
}

Option* Option::needed(const Option* unless) {
  facts_.is_needed = true;
  facts_.unless = unless;
  return this;
}

Option* Option::one_is_needed() {
  facts_.one_is_needed = true;
  return this;
}

Option* Option::excludes(Option* other) {
  parsed_->excludes(other->parsed_);
  return this;
}

Option* Option::needs(Option* other) {
  parsed_->needs(other->parsed_);
  return this;
}

Option* Option::one_of(const std::vector<std::string>& values) {
  CLI::IsMember member(values);  // help shows the values by its description
  member.operation([values](std::string& value) {
    const bool is_one = std::find(values.begin(), values.end(), value) != values.end();
    return is_one ? std::string()
                  : fmt::format("expected {}, found \"{}\"{}", listed(values), value,
                                suggestion(value, values));
  });
  parsed_->check(member);
  return this;
}

Option* Option::number(const std::string& expected, const std::function<bool(double)>& is_allowed,
                       const std::string& shown) {
  expected_ = expected;
  is_allowed_ = is_allowed;
  parsed_->get_validator(0)->description(shown);
  return this;
}

Option* Option::between(int low, int high, const std::string& shown) {
  return number(
      fmt::format("a whole number from {} to {}", low, high),
      [low, high](double value) { return value >= low && value <= high; }, shown);
}

Option* Option::above_zero(const std::string& what) {
  return number(what + " above 0", [](double value) { return value > 0 && std::isfinite(value); });
}

template <class T>
void Option::expect_number() {
  expected_ = std::is_floating_point_v<T> ? "a number"
              : std::is_signed_v<T>       ? "a whole number"
                                          : "a whole number of 0 or more";
  is_allowed_ = [](double /*value*/) { return true; };
  parsed_->check(CLI::Validator(
      [this](std::string& text) {
        const std::optional<T> value = number_of<T>(text);
        return value && is_allowed_(static_cast<double>(*value))
                   ? std::string()
                   : fmt::format("expected {}, found \"{}\"", expected_, text);
      },
      ""));
}

Option* Option::check(const std::function<std::string(const std::string& value)>& fault,
                      const std::string& shown) {
  parsed_->check(fault, shown);
  return this;
}

Option* Option::each(const std::function<void()>& then) {
  parsed_->each([then](const std::string& /*value*/) { then(); });
  return this;
}

std::size_t Option::count() const {
  return parsed_->count();
}

CommandApp::CommandApp(const Command& made_by, const std::string& description, CLI::App* parent)
    : CLI::App(description, made_by.name(), parent), command(made_by) {}

CommandApp::~CommandApp() = default;

Command::Command(const std::string& name, const std::string& description,
                 const std::string& version)
    : name_(name),
      description_(description),
      parent_(nullptr),
      app_(std::make_shared<CommandApp>(*this, description, nullptr)) {
  app_->allow_windows_style_options(false);  // /folder/level.obj is a file there, too
  app_->set_version_flag("-V,--version", version);
  app_->formatter(std::make_shared<HelpFormatter>());
  app_->set_help_flag("-h,--help", "Print the common options");
  app_->set_help_all_flag(kHelpAllFlag, "Print every option of every command");
  app_->failure_message(usage_message);
  app_->require_subcommand(1);
  app_->parse_complete_callback([this] { check_needed(*this); });
}

Command::Command(const std::string& name, const std::string& description, Command& parent)
    : name_(name),
      description_(description),
      parent_(&parent),
      app_(std::make_shared<CommandApp>(*this, description, parent.app_.get())) {
  app_->set_help_all_flag(kHelpAllFlag, "Print every option");
  app_->preparse_callback([this](std::size_t /*arguments*/) {
    stands_too_early_ = false;
    for (const auto& option : parent_->options_) {
      const bool is_needed = option->facts().is_needed && option->parsed()->get_positional();
      stands_too_early_ = stands_too_early_ || (is_needed && option->count() == 0);
    }
  });
}

Command::~Command() = default;

void Command::set_words(std::vector<std::string> words) {
  words_ = std::move(words);
  const auto end = std::find(words_.begin(), words_.end(), kEndOfOptions);
  if (end != words_.end()) behind_end_.assign(end + 1, words_.end());
}

std::string Command::take(const std::vector<std::string>& words) {
  set_words(words);
  try {
    app_->parse(std::vector(words.rbegin(), words.rend()));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return "--help and --version are for command lines";
    return usage_fault(app_.get(), error);
  }
  return {};
}

std::optional<int> Command::run(int argc, char** argv) {
  Result<ExpandedWords> expanded = with_response_files(std::vector<std::string>(argv, argv + argc));
  if (!expanded) return fail(expanded.error());
  empty_lists_ = std::move(expanded->empty_lists);
  set_words(std::move(expanded->words));
  try {
    app_->parse(std::vector(words_.rbegin(), words_.rend() - 1));  // as CLI11 wants them
  } catch (const CLI::ParseError& error) {
    return app_->exit(error) == 0 ? 0 : kExitUsage;
  }
  return std::nullopt;
}

Command& Command::add_command(const std::string& name, const std::string& description) {
  commands_.emplace_back(new Command(name, description, *this));
  app_->add_subcommand(commands_.back()->app_);
  return *commands_.back();
}

const std::vector<std::string>& Command::empty_lists() const {
  return parent_ != nullptr ? parent_->empty_lists() : empty_lists_;
}

bool Command::is_word(const std::string& word) const {
  if (parent_ != nullptr) return parent_->is_word(word);
  return std::find(words_.begin(), words_.end(), word) != words_.end();
}

std::vector<const Command*> Command::commands() const {
  std::vector<const Command*> commands;
  for (const auto& command : commands_) commands.push_back(command.get());
  return commands;
}

const Command* Command::find(const std::string& name) const {
  for (const auto& command : commands_) {
    if (command->name() == name) return command.get();
  }
  return nullptr;
}

std::string Command::summary() const {
  return description_.substr(0, description_.find('\n'));
}

std::vector<std::string> Command::details() const {
  std::istringstream lines(description_);
  std::vector<std::string> paragraphs;
  for (std::string line; std::getline(lines, line);) paragraphs.push_back(line);
  if (!paragraphs.empty()) paragraphs.erase(paragraphs.begin());
  return paragraphs;
}

std::string Command::help() const {
  // CLI::App::help() prints that of the command that was parsed, which may be `help` itself.
  return app_->get_formatter()->make_help(app_.get(), name_, CLI::AppFormatMode::Normal);
}

// CLI11 takes the = of "-o=c.bxt" for the first character of the value, and the end of "-output"
// for the whole of it.
Option* Command::add(CLI::Option* parsed) {
  if (!parsed->get_snames().empty() && parsed->get_expected_max() > 0) {
    const std::string name = parsed->get_snames().front();
    const std::string long_name = parsed->get_lnames().front();
    parsed->check([this, name, long_name](const std::string& value) {
      const std::string joined = "-" + name + value;
      const std::string meant = "-" + joined.substr(0, joined.find('='));
      const bool is_begun = value.size() > 1 && long_name.starts_with(joined.substr(1));
      if (is_word(joined) && (is_begun || app_->get_option_no_throw(meant) != nullptr)) {
        throw CLI::ArgumentMismatch(fmt::format("'{}' is no option; did you mean '{}'?", joined,
                                                is_begun ? "--" + long_name : meant));
      }
      if (!value.starts_with('=')) return std::string();
      return fmt::format("expected -{0} {2} or --{1}={2}, found -{0}={2}", name, long_name,
                         value.substr(1));
    });
  }
  return options_.emplace_back(std::make_unique<Option>(parsed)).get();
}

// An empty value is that of a variable of a script that is not set, and does not leave the option
// out.
Option* Command::add_text(CLI::Option* parsed) {
  if (!parsed->get_positional()) {
    parsed->check([parsed](const std::string& value) {
      return value.empty()
                 ? fmt::format("expected {}, found an empty value", parsed->get_type_name())
                 : std::string();
    });
  }
  return add(parsed);
}

// CLI11 leaves it to the C++ library what characters of a path are.
template <class T>
Option* Command::add_option(const std::string& name, T& out, const std::string& help) {
  if constexpr (std::is_same_v<T, std::filesystem::path>) {
    return add_text(app_->add_option_function<std::string>(
        name, [&out](const std::string& text) { out = named_path(text); }, help));
  } else if constexpr (std::is_same_v<T, std::vector<std::filesystem::path>>) {
    return add_text(app_->add_option_function<std::vector<std::string>>(
        name,
        [&out](const std::vector<std::string>& texts) {
          out.clear();
          for (const std::string& text : texts) out.push_back(named_path(text));
        },
        help));
  }
  if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::optional<double>>) {
    // CLI11 reads numbers as long double, and rounds them twice; 010 is 8 for it.
    using Number = std::conditional_t<std::is_arithmetic_v<T>, T, double>;
    CLI::Option* const parsed = app_->add_option_function<std::string>(
        name, [&out](const std::string& text) { out = number_of<Number>(text).value(); }, help);
    if constexpr (std::is_arithmetic_v<T>) {
      parsed->default_function([&out] { return fmt::format("{}", out); });
    }
    Option* const option = add(parsed);
    option->expect_number<Number>();
    return option;
  } else {
    return add_text(app_->add_option(name, out, help));
  }
}

// What values of options may be.
template Option* Command::add_option(const std::string&, std::string&, const std::string&);
template Option* Command::add_option(const std::string&, std::vector<std::string>&,
                                     const std::string&);
template Option* Command::add_option(const std::string&, std::filesystem::path&,
                                     const std::string&);
template Option* Command::add_option(const std::string&, std::vector<std::filesystem::path>&,
                                     const std::string&);
template Option* Command::add_option(const std::string&, int&, const std::string&);
template Option* Command::add_option(const std::string&, std::uint64_t&, const std::string&);
template Option* Command::add_option(const std::string&, double&, const std::string&);
template Option* Command::add_option(const std::string&, std::optional<double>&,
                                     const std::string&);

Option* Command::add_parsed_option(
    const std::string& name, const std::function<std::string(const std::string& value)>& parse,
    const std::string& help) {
  return add(app_->add_option_function<std::string>(
      name,
      [name, parse](const std::string& value) {
        const std::string fault = parse(value);
        if (!fault.empty()) throw CLI::ValidationError(name, fault);
      },
      help));
}

Option* Command::add_flag(const std::string& name, bool& out, const std::string& help) {
  return add(app_->add_flag(name, out, help));
}

void Command::takes_kinds() {
  app_->require_subcommand(0, 1);
  app_->fallthrough();
}

void Command::callback(const std::function<void()>& then) {
  app_->callback(then);
}

bool Command::has_parsed_command() const {
  return !app_->get_subcommands().empty();
}

OptionFacts Command::facts(const CLI::Option* option) const {
  const auto found = std::find_if(options_.begin(), options_.end(),
                                  [&](const auto& own) { return own->parsed() == option; });
  return found == options_.end() ? OptionFacts() : (*found)->facts();
}

void refuse_without(const std::string& what) {
  throw CLI::RequiredError(what);
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

std::string written(const OptionText& option) {
  std::string text;
  for (const std::string& name : option.names) text += (text.empty() ? "" : ", ") + name;
  if (!option.metavar.empty()) text += (text.empty() ? "" : " ") + option.metavar;
  return text;
}

std::vector<OptionText> positionals_of(const Command& command) {
  std::vector<OptionText> texts;
  for (const CLI::Option* option : command.app().get_options()) {
    if (option->get_positional()) texts.push_back(text_of(command, *option));
  }
  return texts;
}

bool can_end_with(const Command& command, const ExitStatus& status) {
  if (status.number != kExitDifference || command.parent() == nullptr) return true;
  const std::vector<OptionText> options = options_of(command);
  return std::any_of(options.begin(), options.end(), [](const OptionText& option) {
    return option.names == std::vector<std::string>{"--audit"};
  });
}

std::vector<OptionText> options_of(const Command& command) {
  std::vector<OptionText> texts;
  for (const CLI::Option* option : command.app().get_options()) {
    if (option->nonpositional()) texts.push_back(text_of(command, *option));
  }
  std::stable_partition(texts.begin(), texts.end(),
                        [](const OptionText& text) { return !text.is_rare; });
  return texts;
}

std::string call_of(const Command& command) {
  const Command* const parent = command.parent();
  if (parent == nullptr) return command.name();
  std::string call = call_of(*parent);
  for (const OptionText& positional : positionals_of(*parent)) call += " " + positional.metavar;
  return call + " " + command.name();
}

// Options that must be given are named, so that the line can be taken as it is.
std::string arguments_of(const Command& command) {
  std::string line;
  for (const OptionText& positional : positionals_of(command)) {
    const std::string one = positional.metavar + (positional.repeats ? "..." : "");
    line += positional.is_needed ? " " + one : " [" + one + "]";
  }
  bool has_others = false;
  std::string one_of;
  for (const OptionText& option : options_of(command)) {
    const std::string text = option.names.front() + " " + option.metavar;
    if (option.is_needed) {
      line += " " + text;
    } else if (option.facts.one_is_needed) {
      one_of += (one_of.empty() ? "" : " | ") + text;
    } else {
      has_others = true;
    }
  }
  if (!one_of.empty()) line += " (" + one_of + ")";
  if (has_others) line += " [OPTION...]";
  if (!command.commands().empty()) {
    line += command.parent() == nullptr ? " COMMAND ..." : " KIND ...";
  }
  return line;
}

std::string name_of(const Command& command) {
  const Command* const parent = command.parent();
  return parent == nullptr ? command.name() : name_of(*parent) + " " + command.name();
}

}  // namespace boxtree::cooker
