// SPDX-License-Identifier: MIT
// What a command is at, for people who wait: on a terminal one line that overwrites itself.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "cooker/cli/output.h"
#include "cooker/system/descriptor.h"

namespace boxtree::cooker {

/// Steps on a terminal, and only once the work has taken half a second. Elsewhere none, or for work
/// of a minute a line for each that begins two seconds after the last line.
class StepPrinter {
 public:
  enum class Elsewhere { kNothing, kLines };

  explicit StepPrinter(bool enabled, Elsewhere elsewhere = Elsewhere::kNothing)
      : is_terminal_(is_terminal(kStandardError)),
        enabled_(enabled && (is_terminal_ || elsewhere == Elsewhere::kLines)) {}
  StepPrinter(const StepPrinter&) = delete;
  StepPrinter& operator=(const StepPrinter&) = delete;
  ~StepPrinter() { clear(); }
  /// Before something else is printed.
  void clear() {
    if (std::exchange(printed_, false)) static_cast<void>(std::fputs("\r\033[K", stderr));
  }
  void operator()(const std::string& step) {
    if (!enabled_ || Clock::now() - start_ < (is_terminal_ ? kSoon : kLineEvery)) return;
    const std::string line =
        is_terminal_ ? "\r\033[K" + shown(step) + " ..." : "boxtree: " + shown(step) + " ...\n";
    static_cast<void>(std::fputs(line.c_str(), stderr));
    static_cast<void>(std::fflush(stderr));
    printed_ = is_terminal_;
    if (!is_terminal_) start_ = Clock::now();
  }
  /// The same behind a bar, elsewhere a percentage; `share` of the work is done, 0 to 1.
  void operator()(const std::string& step, double share) {
    if (!is_terminal_) return (*this)(fmt::format("[{:3.0f} %] {}", 100 * share, step));
    constexpr int kCells = 24;
    const int done = static_cast<int>(std::clamp(share, 0.0, 1.0) * kCells);
    (*this)(fmt::format("[{:#<{}}{:.<{}}] {}", "", done, "", kCells - done, step));
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kSoon{500}, kLineEvery{2000};

  bool is_terminal_;
  bool enabled_;
  bool printed_ = false;                    // there is a line to clear
  Clock::time_point start_ = Clock::now();  // of the work, or the last line
};

}  // namespace boxtree::cooker
