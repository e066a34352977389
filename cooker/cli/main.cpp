// SPDX-License-Identifier: MIT
// The command line `boxtree`: one sub-command a file.
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cooker/cli/help_format.h"
#include "cooker/cli/output.h"
#include "cooker/cli/usage_message.h"
#include "cooker/version.h"

namespace {

// Memory may run out in code that must not throw, such as destructors of libraries: a message and
// an exit status rather than an abort.
[[noreturn]] void end_at_once() {
  static_cast<void>(
      std::fputs("boxtree: internal: cannot go on, most likely out of memory\n", stderr));
  std::_Exit(boxtree::cooker::kExitInternal);
}

// `boxtree help [COMMAND...]`: what `boxtree COMMAND --help` prints.
void add_help_command(CLI::App& app, int& status) {
  CLI::App& help = *app.add_subcommand("help", "What a command does and takes");
  const auto names = std::make_shared<std::vector<std::string>>();
  help.add_option("command", *names, "A command, and a kind of query")->type_name("COMMAND");
  help.callback([&app, names, &status] {
    const CLI::App* at = &app;
    for (const std::string& word : *names) {
      const CLI::App* const command = boxtree::cooker::find_command(*at, word);
      if (command == nullptr) {
        status = boxtree::cooker::usage(boxtree::cooker::unknown_command(*at, word));
        return;
      }
      at = command;
    }
    fmt::print("{}", at->help());
  });
}

}  // namespace

int main(int argc, char** argv) {
  using namespace boxtree;
  int status = 0;
  std::set_terminate(end_at_once);
#ifdef SIGXFSZ
  // A limit of file sizes is an error of the write, which is reported and leaves no half a file.
  static_cast<void>(std::signal(SIGXFSZ, SIG_IGN));
#endif
  try {
    CLI::App app{"Cooks meshes into small collision trees and queries them.", "boxtree"};
    app.set_version_flag("-V,--version", fmt::format("boxtree {}", cooker::kVersion));
    app.formatter(std::make_shared<cooker::HelpFormatter>());
    app.set_help_flag("-h,--help", "Print the common options");
    app.set_help_all_flag("--help-all", "Print every option of every command");
    app.failure_message(cooker::usage_message);
    app.require_subcommand(1);
    app.footer(
        "Exit status: 0 ok, 1 usage, 2 input/output, 3 bad input, 4 internal, 5 unsupported.");
    cooker::add_cook_command(app, status);
    cooker::add_info_command(app, status);
    cooker::add_verify_command(app, status);
    cooker::add_query_command(app, status);
    cooker::add_bench_command(app, status);
    cooker::add_report_command(app, status);
    cooker::add_export_command(app, status);
    add_help_command(app, status);
    try {
      app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      return app.exit(error) == 0 ? 0 : cooker::kExitUsage;
    }
  } catch (const std::bad_alloc&) {
    static_cast<void>(std::fputs("boxtree: out of memory\n", stderr));
    return cooker::kExitInternal;
  } catch (const std::exception& error) {
    if (std::ferror(stdout) != 0) return boxtree::cooker::fail_to_print();
    cooker::complain(std::string("internal: ") + error.what());
    return cooker::kExitInternal;
  }
  return std::fflush(stdout) == 0 ? status : cooker::fail_to_print();
}
