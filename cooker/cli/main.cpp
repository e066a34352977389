// SPDX-License-Identifier: MIT
// The command line `boxtree`: one sub-command a file.
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <new>
#include <string>

#include <fmt/format.h>

#include "cooker/cli/command.h"
#include "cooker/cli/commands.h"
#include "cooker/cli/exit_status.h"
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
    cooker::Command app("boxtree",
                        "Cooks meshes into small collision trees and queries them.\n"
                        "A file called - is standard input or standard output; one of that name is "
                        "./-.");
    app.set_version_flag("-V,--version", fmt::format("boxtree {}", cooker::kVersion));
    app.formatter(std::make_shared<cooker::HelpFormatter>());
    app.set_help_flag("-h,--help", "Print the common options");
    app.set_help_all_flag(cooker::kHelpAllFlag, "Print every option of every command");
    app.failure_message(cooker::usage_message);
    app.require_subcommand(1);
    app.parse_complete_callback([&app] { cooker::check_needed(app); });
    cooker::add_cook_command(app, status);
    cooker::add_info_command(app, status);
    cooker::add_verify_command(app, status);
    cooker::add_query_command(app, status);
    cooker::add_bench_command(app, status);
    cooker::add_report_command(app, status);
    cooker::add_export_command(app, status);
    cooker::add_completion_command(app, status);
    cooker::add_help_command(app, status);
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
