// SPDX-License-Identifier: MIT
// Compiled elsewhere, this is nothing: see process_posix.cpp.
#ifdef _WIN32
#include <chrono>

#include "cooker/system/process.h"
#include "runtime/file/windows_path.h"
// clang-format off
#include <psapi.h>  // needs windows.h before it
// clang-format on

namespace boxtree::cooker {
namespace {

PROCESS_MEMORY_COUNTERS counters() noexcept {
  PROCESS_MEMORY_COUNTERS counters{};
  static_cast<void>(::K32GetProcessMemoryInfo(::GetCurrentProcess(), &counters, sizeof(counters)));
  return counters;
}

}  // namespace

double thread_seconds() noexcept {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

std::uint64_t peak_bytes() noexcept {
  return counters().PeakWorkingSetSize;
}

std::uint64_t memory_bytes() noexcept {
  MEMORYSTATUSEX status{};
  status.dwLength = sizeof(status);
  return ::GlobalMemoryStatusEx(&status) != 0 ? status.ullTotalPhys : 0;
}

std::uint64_t page_faults() noexcept {
  return counters().PageFaultCount;
}

}  // namespace boxtree::cooker
#endif
