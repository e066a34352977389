// SPDX-License-Identifier: MIT
// --jobs: on how many threads a command works.
#pragma once

#include <functional>

namespace boxtree::cooker {

/// As many as the machine has, which is the default of --jobs.
inline constexpr int kAllThreads = -1;

/// Runs `work`, whose parallel loops use up to `jobs` threads, this one included: no more than the
/// machine has, and than can be started, since a limit of processes (ulimit -u, a container's) is
/// no reason to fail. Returns when all is done.
void run_on_threads(int jobs, const std::function<void()>& work);

}  // namespace boxtree::cooker
