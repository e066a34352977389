// SPDX-License-Identifier: MIT
#include "cooker/cli/man_page.h"

#include <algorithm>
#include <cctype>
#include <string_view>

#include "cooker/cli/exit_status.h"
#include "cooker/version.h"

namespace boxtree::cooker {
namespace {

// Text as troff takes it literally. Hyphens are those of options, which can be copied.
std::string literal(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else if (c == '\'') {
      out += "\\(aq";
    } else if (c == '`') {
      out += "\\(ga";
    } else if (c == '^') {
      out += "\\(ha";
    } else if (c == '~') {
      out += "\\(ti";
    } else {
      out += c;
    }
  }
  return out;
}

// A line of its own; one that begins like a request is none.
std::string line_of_text(std::string_view text) {
  const bool is_request = text.starts_with('.');
  return (is_request ? "\\&" : "") + literal(text) + "\n";
}

std::string bold(std::string_view text) {
  return "\\fB" + literal(text) + "\\fR";
}
std::string italic(std::string_view text) {
  return "\\fI" + literal(text) + "\\fR";
}

std::string section(const char* title) {
  return std::string(".SH ") + title + "\n";
}

std::string page_name(const Command& command) {
  std::string name = name_of(command);
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

// "-o, --output FILE".
std::string title_of(const OptionText& option) {
  std::string title;
  for (const std::string& name : option.names) title += (title.empty() ? "" : ", ") + bold(name);
  if (!option.metavar.empty()) title += (title.empty() ? "" : " ") + italic(option.metavar);
  if (option.repeats) title += "...";
  return title;
}

std::string list(const std::vector<OptionText>& options) {
  std::string text;
  for (const OptionText& option : options) {
    text += ".TP\n" + title_of(option) + "\n" + line_of_text(option.description);
  }
  return text;
}

std::string call(const Command& command) {
  return bold(call_of(command)) + literal(arguments_of(command)) + "\n";
}

std::string paragraphs(const Command& command) {
  std::string text;
  for (const std::string& each : command.details()) text += ".PP\n" + line_of_text(each);
  return text;
}

// "ray" of `boxtree query`: its summary, how it is called, what it takes.
std::string kind_section(const Command& kind) {
  return ".SS " + literal(kind.name()) + "\n" + line_of_text(kind.summary() + ".") + ".PP\n" +
         call(kind) + paragraphs(kind) + list(positionals_of(kind)) + list(options_of(kind));
}

std::string example_text(const Example& example) {
  return line_of_text(example.what + ":") + ".PP\n.RS 4\n.EX\n" + line_of_text(example.line) +
         ".EE\n.RE\n";
}

// Those of a command, and of its kinds behind them.
void add_examples(const Command& command, std::vector<std::string>& examples) {
  for (const Example& example : command.examples()) examples.push_back(example_text(example));
  for (const Command* kind : command.commands()) add_examples(*kind, examples);
}

std::string joined(const std::vector<std::string>& paragraphs) {
  std::string text;
  for (const std::string& paragraph : paragraphs) text += (text.empty() ? "" : ".PP\n") + paragraph;
  return text;
}

std::string statuses(const Command& command) {
  std::string text;
  for (const ExitStatus& status : kExitStatuses) {
    if (!can_end_with(command, status)) continue;
    text += ".TP\n" + bold(std::to_string(status.number)) + "\n" + line_of_text(status.meaning);
  }
  return text + ".PP\n" + line_of_text(kOtherStatuses);
}

// The other pages, in the order of the alphabet.
std::string see_also(const Command& command) {
  const Command& program = command.parent() == nullptr ? command : *command.parent();
  std::vector<std::string> names;
  if (&program != &command) names.push_back(page_name(program));
  for (const Command* other : program.commands()) {
    if (other != &command) names.push_back(page_name(*other));
  }
  std::sort(names.begin(), names.end());
  std::string text;
  for (const std::string& name : names) {
    text += bold(name) + "(1)" + (&name == &names.back() ? "\n" : ",\n");
  }
  return text;
}

std::string name_section(const Command& command) {
  std::string summary = command.summary();
  summary.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(summary.front())));
  if (summary.ends_with('.')) summary.pop_back();
  return section("NAME") + literal(page_name(command)) + " \\- " + literal(summary) + "\n";
}

std::string page_of_program(const Command& program) {
  std::string text = section("SYNOPSIS") + call(program) + section("DESCRIPTION") +
                     line_of_text(program.summary()) + paragraphs(program) + section("OPTIONS") +
                     list(options_of(program)) + section("COMMANDS");
  std::vector<std::string> examples;
  for (const Command* command : program.commands()) {
    text += ".TP\n" + bold(page_name(*command)) + "(1)\n" + line_of_text(command->summary() + ".");
    if (!command->examples().empty()) examples.push_back(example_text(command->examples().front()));
  }
  return text + section("EXIT STATUS") + statuses(program) + section("EXAMPLES") + joined(examples);
}

std::string page_of_command(const Command& command) {
  std::vector<std::string> calls{call(command)};
  for (const Command* kind : command.commands()) calls.push_back(call(*kind));
  std::string text = section("SYNOPSIS") + joined(calls) + section("DESCRIPTION") +
                     line_of_text(command.summary() + ".") + paragraphs(command) +
                     section("OPTIONS") + list(positionals_of(command)) + list(options_of(command));
  if (!command.commands().empty()) text += section("KINDS");
  for (const Command* kind : command.commands()) text += kind_section(*kind);
  text += section("EXIT STATUS") + statuses(command);
  std::vector<std::string> examples;
  add_examples(command, examples);
  return examples.empty() ? text : text + section("EXAMPLES") + joined(examples);
}

}  // namespace

ManPage man_page(const Command& command) {
  std::string name = page_name(command);
  std::string title = name;
  std::transform(title.begin(), title.end(), title.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  std::string text = ".\\\" Made by boxtree help --man\n.TH " + title + " 1 \"\" \"boxtree " +
                     std::string(kVersion) + "\" \"User Commands\"\n.nh\n.ad l\n" +
                     name_section(command);
  text += command.parent() == nullptr ? page_of_program(command) : page_of_command(command);
  text += section("SEE ALSO") + see_also(command);
  return {std::move(name), std::move(text)};
}

std::vector<ManPage> all_man_pages(const Command& program) {
  std::vector<ManPage> pages{man_page(program)};
  for (const Command* command : program.commands()) pages.push_back(man_page(*command));
  return pages;
}

}  // namespace boxtree::cooker
