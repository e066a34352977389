// SPDX-License-Identifier: MIT
// How much of the time of a measurement other programs had the processor.
#pragma once

#include <chrono>

#include "cooker/choose/measure.h"
#include "cooker/system/process.h"

namespace boxtree::cooker {

/// Time that one thread spent on what it measured.
class TimedWork {
 public:
  TimedWork() = default;
  TimedWork(double processor_seconds, double elapsed_seconds)
      : processor_seconds_(processor_seconds), elapsed_seconds_(elapsed_seconds) {}

  /// Adds the time of a call; returns what it returns.
  template <class Body>
  auto add(Body body) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    const double processor = thread_seconds();
    auto result = body();
    processor_seconds_ += thread_seconds() - processor;
    elapsed_seconds_ += std::chrono::duration<double>(Clock::now() - start).count();
    return result;
  }

  /// Of the elapsed time, how much the thread had a processor, 0 to 1. 1 if nothing was measured.
  [[nodiscard]] double processor_share() const noexcept;

 private:
  double processor_seconds_ = 0;
  double elapsed_seconds_ = 0;
};

/// Whether a thread that only computes had a processor for so little of the time that other
/// programs ran in its place, and its times are not those of an idle machine.
[[nodiscard]] bool is_disturbed(double processor_share) noexcept;

}  // namespace boxtree::cooker
