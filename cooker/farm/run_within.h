// SPDX-License-Identifier: MIT
// Runs many tasks side by side under one budget of memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

namespace boxtree::cooker {

struct MemoryTasks {
  std::size_t count = 0;
  std::uint64_t memory_bytes = 0;  // that all that run may take together
  /// What a task will take. Called once for each, in order, by one thread at a time.
  std::function<std::uint64_t(std::size_t task)> estimate;
  /// Called by any thread of the arena. Must not throw.
  std::function<void(std::size_t task)> run;
  /// Whether no more tasks are to start.
  std::function<bool()> is_stopped;
};

/// Runs all tasks on the threads of the enclosing oneTBB arena, no more at once than it has, and
/// returns when they have ended. They start in order, each as soon as its estimate fits beside
/// those that run; one that does not fit alone runs alone. Loops inside a task use threads that are
/// free and start no other task, so that a task ends when its own work has.
void run_within(const MemoryTasks& tasks);

}  // namespace boxtree::cooker
