// SPDX-License-Identifier: MIT
// oneTBB's task_group for ThreadSanitizer: each task is a thread.
#pragma once

#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace tbb {

class task_group {
 public:
  /// May be called by tasks of the group, too.
  template <class Task>
  void run(Task task) {
    const std::lock_guard lock(mutex_);
    threads_.emplace_back(std::move(task));
  }

  /// Also for tasks that tasks start: a thread is in the list before the one that starts it ends.
  void wait() {
    for (;;) {
      std::thread last;
      {
        const std::lock_guard lock(mutex_);
        if (threads_.empty()) return;
        last = std::move(threads_.back());
        threads_.pop_back();
      }
      last.join();
    }
  }

 private:
  std::mutex mutex_;
  std::vector<std::thread> threads_;
};

}  // namespace tbb
