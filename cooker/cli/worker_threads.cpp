// SPDX-License-Identifier: MIT
// oneTBB starts threads when a loop needs them, and ends the process where one cannot be started,
// so how many can be is found out before.
#include "cooker/cli/worker_threads.h"

#include <algorithm>
#include <latch>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

#include <oneapi/tbb/info.h>
#include <oneapi/tbb/task_arena.h>

namespace boxtree::cooker {
namespace {

// How many threads beside this one can run at once, `most` at most.
int startable_threads(int most) {
  std::latch all_started(1);
  std::vector<std::thread> threads;
  threads.reserve(static_cast<std::size_t>(most));
  try {
    while (static_cast<int>(threads.size()) < most) {
      threads.emplace_back([&all_started] { all_started.wait(); });
    }
  } catch (const std::system_error&) {  // no more than these
  } catch (const std::bad_alloc&) {     // nor for want of memory
  }
  all_started.count_down();
  for (std::thread& thread : threads) thread.join();
  return static_cast<int>(threads.size());
}

}  // namespace

void run_on_threads(int jobs, const std::function<void()>& work) {
  const int most = tbb::info::default_concurrency();
  const int wanted = jobs == kAllThreads ? most : std::min(jobs, most);
  tbb::task_arena arena(1 + startable_threads(wanted - 1));
  arena.execute(work);
}

}  // namespace boxtree::cooker
