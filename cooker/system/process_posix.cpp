// SPDX-License-Identifier: MIT
// Compiled on Windows, this is nothing: see process_windows.cpp.
#ifndef _WIN32
#include <algorithm>
#include <ctime>
#include <sys/resource.h>
#include <unistd.h>

#include "cooker/system/process.h"

namespace boxtree::cooker {
namespace {

rusage usage() noexcept {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return usage;
}

}  // namespace

double thread_seconds() noexcept {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

std::uint64_t peak_bytes() noexcept {
#ifdef __APPLE__
  constexpr std::uint64_t kUnit = 1;
#else
  constexpr std::uint64_t kUnit = 1024;
#endif
  return static_cast<std::uint64_t>(usage().ru_maxrss) * kUnit;
}

std::uint64_t memory_bytes() noexcept {
  const auto pages = static_cast<std::uint64_t>(std::max(0L, ::sysconf(_SC_PHYS_PAGES)));
  return pages * static_cast<std::uint64_t>(std::max(0L, ::sysconf(_SC_PAGESIZE)));
}

std::uint64_t page_faults() noexcept {
  return static_cast<std::uint64_t>(usage().ru_minflt);
}

}  // namespace boxtree::cooker
#endif
