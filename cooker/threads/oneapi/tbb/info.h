// SPDX-License-Identifier: MIT
// oneTBB's default_concurrency for builds without oneTBB.
#pragma once

#include <algorithm>
#include <thread>

namespace tbb::info {

/// How many threads this machine runs at once; at least 1.
[[nodiscard]] inline int default_concurrency() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace tbb::info
