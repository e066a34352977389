// SPDX-License-Identifier: MIT
// What other programs did to a measurement: how much of its time they had the processor, and by how
// much they made it slower (on the other thread of a core, on the host of a virtual machine).
#pragma once

#include <chrono>
#include <string>

#include "cooker/choose/measure.h"
#include "cooker/system/process.h"

namespace boxtree::cooker {

/// Time that one thread spent on what it measured.
class TimedWork {
 public:
  TimedWork() = default;
  TimedWork(double processor_seconds, double elapsed_seconds, double speed_ratio = 1)
      : processor_seconds_(processor_seconds),
        elapsed_seconds_(elapsed_seconds),
        fastest_piece_(1),
        slowest_piece_(speed_ratio) {}

  /// Adds the time of a call; returns what it returns. Before and after it a piece of work is done
  /// that is always the same, some milliseconds.
  template <class Body>
  auto add(Body body) {
    using Clock = std::chrono::steady_clock;
    add_piece();
    const Clock::time_point start = Clock::now();
    const double processor = thread_seconds();
    auto result = body();
    processor_seconds_ += thread_seconds() - processor;
    elapsed_seconds_ += std::chrono::duration<double>(Clock::now() - start).count();
    add_piece();
    return result;
  }

  /// Of the elapsed time, how much the thread had a processor, 0 to 1. 1 if nothing was measured.
  [[nodiscard]] double processor_share() const noexcept;

  /// The longest time of a piece over the shortest, 1 or more. 1 if nothing was measured.
  [[nodiscard]] double speed_ratio() const noexcept;

  /// Whether other programs ran in the place of a thread that only computes.
  [[nodiscard]] bool lacks_processor() const noexcept;
  /// Whether its times are not those of an idle machine: it lacks the processor, or this was
  /// slower at some times than at others.
  [[nodiscard]] bool is_disturbed() const noexcept;
  /// What disturbed it, as the first half of a sentence; empty if nothing did.
  [[nodiscard]] std::string disturbance() const;
  /// A warning of it, of what follows ("times may be wrong"), and of what to do; empty if nothing
  /// did.
  [[nodiscard]] std::string warning(const std::string& what_follows) const;

 private:
  void add_piece();

  double processor_seconds_ = 0;
  double elapsed_seconds_ = 0;
  double fastest_piece_ = 0;  // 0: none
  double slowest_piece_ = 0;
};

}  // namespace boxtree::cooker
