// SPDX-License-Identifier: MIT
// Compiled on Windows, this is nothing: see process_windows.cpp.
#ifndef _WIN32
#include <algorithm>
#include <ctime>
#include <exception>
#include <fstream>
#include <sstream>
#include <sys/resource.h>
#include <unistd.h>

#include "cooker/system/memory_limit.h"
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
  const auto of_machine = pages * static_cast<std::uint64_t>(std::max(0L, ::sysconf(_SC_PAGESIZE)));
#ifdef __linux__
  try {
    std::ostringstream groups;
    groups << std::ifstream("/proc/self/cgroup").rdbuf();
    if (const auto limit = memory_limit(groups.str(), "/sys/fs/cgroup")) {
      return std::min(of_machine, *limit);
    }
  } catch (const std::exception&) {  // then the machine's is the best that is known
  }
#endif
  return of_machine;
}

std::uint64_t page_faults() noexcept {
  return static_cast<std::uint64_t>(usage().ru_minflt);
}

}  // namespace boxtree::cooker
#endif
