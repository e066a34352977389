// SPDX-License-Identifier: MIT
// oneTBB's parallel_invoke for builds without oneTBB: a thread is started and joined, which
// ThreadSanitizer sees.
#pragma once

#include <thread>

#include <oneapi/tbb/task_arena.h>

namespace tbb {

/// Runs both and returns when both have ended. An exception ends the program.
template <class Left, class Right>
void parallel_invoke(const Left& left, const Right& right) noexcept {
  const int jobs = task_arena::jobs();
  if (jobs < 2) {
    left();
    right();
    return;
  }
  std::thread other([&] { task_arena(jobs / 2).execute(left); });
  task_arena(jobs - jobs / 2).execute(right);
  other.join();
}

}  // namespace tbb
