// SPDX-License-Identifier: MIT
// `boxtree help` and `boxtree completion`: what is declared, as text, man pages and scripts.
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cooker/cli/command.h"
#include "cooker/cli/commands.h"
#include "cooker/cli/completion.h"
#include "cooker/cli/man_page.h"
#include "cooker/cli/output.h"
#include "cooker/cli/usage_message.h"
#include "cooker/write/atomic_file.h"

namespace boxtree::cooker {
namespace {

struct HelpArguments {
  std::vector<std::string> names;
  bool man = false;
  std::filesystem::path folder;
};

int write_pages(const Command& program, const std::filesystem::path& folder) {
  for (const ManPage& page : all_man_pages(program)) {
    Result<AtomicFile> file = AtomicFile::create(folder / (page.name + ".1"));
    if (!file) return fail(file.error());
    if (Status status = file->write(std::as_bytes(std::span(page.text))); !status) {
      return fail(status.error());
    }
    if (Status status = file->commit(); !status) return fail(status.error());
  }
  return 0;
}

int run_help(const Command& program, const HelpArguments& arguments) {
  if (!arguments.folder.empty()) return write_pages(program, arguments.folder);
  const Command* at = &program;
  for (const std::string& word : arguments.names) {
    const Command* const command = at->find(word);
    if (command == nullptr && at->commands().empty()) {
      return usage(fmt::format("help: '{}' was not expected: {} has no commands of its own", word,
                               name_of(*at)));
    }
    if (command == nullptr) return usage(unknown_command(*at, word));
    at = command;
  }
  if (!arguments.man) {
    fmt::print("{}", at->help());
    return 0;
  }
  if (arguments.names.size() > 1) {
    return usage(fmt::format("{}: no man page of its own; it is in that of {}", name_of(*at),
                             name_of(*at->parent())));
  }
  fmt::print("{}", man_page(*at).text);
  return 0;
}

}  // namespace

void add_completion_command(Command& program, int& status) {
  Command& command = program.add_command(
      "completion",
      "Print the completion script for a shell\n"
      "Where boxtree is installed, its scripts are, too. Otherwise bash and zsh take the script "
      "from "
      "a file that is sourced or, in zsh, called _boxtree in a folder of fpath; fish from "
      "~/.config/fish/completions/boxtree.fish.");
  const auto shell = std::make_shared<std::string>();
  command.add_option("SHELL", *shell, "The shell")
      ->one_of({kShells.begin(), kShells.end()})
      ->needed();
  command.example("Completion in this bash", "source <(boxtree completion bash)");
  command.callback([&program, shell, &status] {
    fmt::print("{}", completion_script(program, *shell));
    status = 0;
  });
}

void add_help_command(Command& program, int& status) {
  Command& command = program.add_command("help", "Show what a command does and takes");
  const auto arguments = std::make_shared<HelpArguments>();
  Option* names = command.add_option("COMMAND", arguments->names, "A command, and a kind of query")
                      ->takes(Values::kCommands);
  command.add_flag("--man", arguments->man, "Print the man page, in troff");
  command.add_option("--man-pages", arguments->folder, "Write all man pages into a folder")
      ->takes(Values::kFolders)
      ->type_name("FOLDER")
      ->group(kRareOptions)
      ->excludes(names);
  command.example("The man page of a command", "boxtree help --man query | man -l -");
  command.callback([&program, arguments, &status] { status = run_help(program, *arguments); });
}

}  // namespace boxtree::cooker
