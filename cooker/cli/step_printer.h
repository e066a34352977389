// SPDX-License-Identifier: MIT
// What a command is at: one line that overwrites itself, for people who wait.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <unistd.h>

#include <fmt/format.h>

#include "cooker/cli/output.h"

namespace boxtree::cooker {

/// Steps on a terminal only, and only once the work has taken half a second.
class StepPrinter {
 public:
  explicit StepPrinter(bool enabled) : enabled_(enabled && ::isatty(STDERR_FILENO) == 1) {}
  StepPrinter(const StepPrinter&) = delete;
  StepPrinter& operator=(const StepPrinter&) = delete;
  ~StepPrinter() {
    if (printed_) static_cast<void>(std::fputs("\r\033[K", stderr));
  }
  void operator()(const std::string& step) {
    if (!enabled_ || Clock::now() - start_ < std::chrono::milliseconds(500)) return;
    const std::string line = "\r\033[K" + shown(step) + " ...";
    static_cast<void>(std::fputs(line.c_str(), stderr));
    static_cast<void>(std::fflush(stderr));
    printed_ = true;
  }
  /// The same behind a bar; `share` of the work is done, 0 to 1.
  void operator()(const std::string& step, double share) {
    constexpr int kCells = 24;
    const int done = static_cast<int>(std::clamp(share, 0.0, 1.0) * kCells);
    (*this)(fmt::format("[{:#<{}}{:.<{}}] {}", "", done, "", kCells - done, step));
  }

 private:
  using Clock = std::chrono::steady_clock;
  bool enabled_;
  bool printed_ = false;
  Clock::time_point start_ = Clock::now();
};

}  // namespace boxtree::cooker
