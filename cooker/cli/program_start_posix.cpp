// SPDX-License-Identifier: MIT
// Compiled on Windows, this is nothing: see program_start_windows.cpp.
#ifndef _WIN32
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <fcntl.h>
#include <new>
#include <sys/mman.h>
#include <sys/resource.h>

#include "cooker/cli/program_start.h"
#include "cooker/system/descriptor.h"

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

// A standard stream that is closed leaves its number to the next file that is opened, into which
// all that is printed would be written. So each is opened, the other way round: what reads or
// writes it is still told that it is closed (EBADF). Without a null device it is a folder.
void reserve_standard_streams() {
  for (const int stream : {kStandardInput, kStandardOutput, kStandardError}) {
    if (::fcntl(stream, F_GETFD) >= 0 || errno != EBADF) continue;
    // The lowest number that is free: this stream's, since those below it are open. Where no file
    // can be opened, none takes its place, either.
    if (::open("/dev/null", stream == kStandardInput ? O_WRONLY : O_RDONLY) >= 0) continue;
    static_cast<void>(::open("/", O_RDONLY));
  }
}

}  // namespace

void prepare_process(int& /*argc*/, char**& /*argv*/) {
  reserve_standard_streams();
#ifdef SIGXFSZ
  // A limit of file sizes is an error of the write, which is reported and leaves no half a file.
  static_cast<void>(std::signal(SIGXFSZ, SIG_IGN));
#endif
  grow_stack();
}

}  // namespace boxtree::cooker
#endif
