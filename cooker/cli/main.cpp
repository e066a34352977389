// SPDX-License-Identifier: MIT
// The command line `boxtree`: one sub-command a file.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "cooker/cli/command.h"
#include "cooker/cli/commands.h"
#include "cooker/cli/exit_status.h"
#include "cooker/cli/output.h"
#include "cooker/cli/program_start.h"
#include "cooker/farm/cooker_identity.h"
#include "cooker/farm/import_libraries.h"
#include "cooker/import/assimp_import.h"
#include "cooker/version.h"
#include "runtime/blob/compressor.h"

namespace {

// Memory may run out in code that must not throw, such as destructors of libraries: a message and
// an exit status rather than an abort.
[[noreturn]] void end_at_once() {
  static_cast<void>(
      std::fputs("boxtree: internal: cannot go on, most likely out of memory\n", stderr));
  std::_Exit(boxtree::cooker::kExitInternal);
}

// All versions that bytes of a file may depend on, for keys of caches.
std::string version_text() {
  using namespace boxtree;
  const std::string& libraries = cooker::import_libraries();
  return fmt::format("boxtree {}, sources {}\nassimp {}, liblzma {}, zstd {}{}{}", cooker::kVersion,
                     cooker::kSourceDigest, cooker::assimp_version(), lzma_version(),
                     zstd_version(), libraries.empty() ? "" : "\n", libraries);
}

}  // namespace

int main(int argc, char** argv) {
  using namespace boxtree;
  int status = 0;
  std::set_terminate(end_at_once);
  try {
    cooker::prepare_process(argc, argv);
    cooker::Command app("boxtree",
                        "Cooks meshes into small collision trees and queries them.\n"
                        "A file called - is standard input or standard output; one of that name is "
                        "./-.",
                        version_text());
    cooker::add_cook_command(app, status);
    cooker::add_info_command(app, status);
    cooker::add_verify_command(app, status);
    cooker::add_query_command(app, status);
    cooker::add_bench_command(app, status);
    cooker::add_report_command(app, status);
    cooker::add_export_command(app, status);
    cooker::add_key_command(app, status);
    cooker::add_pack_command(app, status);
    cooker::add_split_command(app, status);
    cooker::add_tile_command(app, status);
    cooker::add_merge_command(app, status);
    cooker::add_completion_command(app, status);
    cooker::add_help_command(app, status);
    if (const std::optional<int> ended = app.run(argc, argv); ended) status = *ended;
  } catch (const std::bad_alloc&) {
    // Not by complain(), which takes memory. The command is what the error is in.
    static_cast<void>(std::fprintf(stderr,
                                   "boxtree: out_of_memory: %s: there is too little memory\n",
                                   argc > 1 ? argv[1] : "boxtree"));
    return cooker::kExitInternal;
  } catch (const std::exception& error) {
    if (std::ferror(stdout) != 0) return boxtree::cooker::fail_to_print();
    cooker::complain(fmt::format("internal: {}: {}", argc > 1 ? argv[1] : "boxtree", error.what()));
    return cooker::kExitInternal;
  }
  // What was printed before may have failed, too.
  const bool is_printed = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  return is_printed ? status : cooker::fail_to_print();
}
