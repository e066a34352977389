// SPDX-License-Identifier: MIT
// The command line `boxtree`: one sub-command a file.
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <sys/mman.h>
#include <sys/resource.h>

#include <fmt/format.h>

#include "cooker/cli/command.h"
#include "cooker/cli/commands.h"
#include "cooker/cli/exit_status.h"
#include "cooker/cli/output.h"
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

// distance() takes most: 512 KB (docs/api/threads.md), and those that call it less than half of
// that.
constexpr std::size_t kStackBytes = 768 * 1024;
constexpr std::size_t kPageBytes = 4096;

[[gnu::noinline]] void touch_stack() {
  [[maybe_unused]] volatile char bytes[kStackBytes];
  for (std::size_t at = kStackBytes; at > 0; at -= kPageBytes) bytes[at - 1] = 0;
}

// A stack that cannot grow when a function needs it ends the program by SIGSEGV. So it grows now,
// where too little memory can still be told.
void grow_stack() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur < 2 * kStackBytes) return;
  void* const room =
      ::mmap(nullptr, kStackBytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (room == MAP_FAILED) throw std::bad_alloc();
  static_cast<void>(::munmap(room, kStackBytes));
  touch_stack();
}

// All versions that bytes of a file may depend on, for keys of caches.
std::string version_text() {
  using namespace boxtree;
  return fmt::format("boxtree {}\nassimp {}, liblzma {}, zstd {}", cooker::kVersion,
                     cooker::assimp_version(), lzma_version(), zstd_version());
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
    grow_stack();
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
