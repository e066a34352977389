// SPDX-License-Identifier: MIT
#include "cooker/farm/run_within.h"

#include <mutex>
#include <optional>

#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

namespace boxtree::cooker {
namespace {

// No thread waits for memory: each task that ends starts those that then fit.
class Runner {
 public:
  explicit Runner(const MemoryTasks& tasks)
      : tasks_(tasks),
        threads_(static_cast<std::size_t>(tbb::this_task_arena::max_concurrency())) {}

  void run() {
    start_those_that_fit();
    group_.wait();
  }

 private:
  void start_those_that_fit() {
    const std::lock_guard lock(mutex_);
    while (next_ < tasks_.count && running_ < threads_ && !tasks_.is_stopped()) {
      if (!estimate_) estimate_ = tasks_.estimate(next_);
      const bool fits = *estimate_ <= tasks_.memory_bytes - taken_bytes_;
      if (!fits && running_ > 0) return;
      const std::uint64_t bytes = fits ? *estimate_ : tasks_.memory_bytes - taken_bytes_;
      estimate_.reset();
      taken_bytes_ += bytes;
      ++running_;
      group_.run([this, task = next_++, bytes] {
        tbb::this_task_arena::isolate([&] { tasks_.run(task); });
        end(bytes);
      });
    }
  }

  void end(std::uint64_t bytes) {
    {
      const std::lock_guard lock(mutex_);
      taken_bytes_ -= bytes;
      --running_;
    }
    start_those_that_fit();
  }

  const MemoryTasks& tasks_;
  const std::size_t threads_;
  tbb::task_group group_;
  std::mutex mutex_;
  std::size_t next_ = 0, running_ = 0;
  std::uint64_t taken_bytes_ = 0;          // never more than the budget
  std::optional<std::uint64_t> estimate_;  // of the next one
};

}  // namespace

void run_within(const MemoryTasks& tasks) {
  Runner(tasks).run();
}

}  // namespace boxtree::cooker
