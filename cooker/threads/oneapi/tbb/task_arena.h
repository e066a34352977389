// SPDX-License-Identifier: MIT
// oneTBB's task_arena for builds without oneTBB: a number of threads to share out among tasks.
#pragma once

namespace tbb {

class task_arena {
 public:
  static constexpr int automatic = -1;

  explicit task_arena(int jobs = automatic) : jobs_(jobs == automatic ? kDefaultJobs : jobs) {}

  /// Runs `work` on this thread; tasks that it starts use up to the arena's number of threads.
  template <class Work>
  void execute(const Work& work) const {
    const int before = jobs();
    jobs() = jobs_;
    work();
    jobs() = before;
  }

  /// What the calling thread may use: itself and the threads that it starts.
  static int& jobs() {
    static thread_local int jobs = kDefaultJobs;
    return jobs;
  }

 private:
  // Outside an arena. More than one on every machine: races are looked for on machines with one
  // processor, too.
  static constexpr int kDefaultJobs = 4;

  int jobs_;
};

namespace this_task_arena {

inline int max_concurrency() {
  return task_arena::jobs();
}

/// A thread has one task at a time, which is all that isolation is for.
template <class Work>
void isolate(const Work& work) {
  work();
}

}  // namespace this_task_arena

}  // namespace tbb
