// SPDX-License-Identifier: MIT
// Compiled on Windows, this is nothing: see program_start_windows.cpp.
#ifndef _WIN32
#include <csignal>
#include <cstddef>
#include <new>
#include <sys/mman.h>
#include <sys/resource.h>

#include "cooker/cli/program_start.h"

#ifndef MAP_NORESERVE  // macOS has none, and reserves nothing
#define MAP_NORESERVE 0
#endif

namespace boxtree::cooker {
namespace {

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

}  // namespace

void prepare_process(int& /*argc*/, char**& /*argv*/) {
#ifdef SIGXFSZ
  // A limit of file sizes is an error of the write, which is reported and leaves no half a file.
  static_cast<void>(std::signal(SIGXFSZ, SIG_IGN));
#endif
  grow_stack();
}

}  // namespace boxtree::cooker
#endif
