// SPDX-License-Identifier: MIT
// oneTBB's parallel_for for builds without oneTBB.
#pragma once

#include <oneapi/tbb/parallel_invoke.h>

namespace tbb {

/// Halves the range until it is not divisible or the threads are used up.
template <class Range, class Body>
void parallel_for(const Range& range, const Body& body) noexcept {
  if (task_arena::jobs() < 2 || !range.is_divisible()) {
    body(range);
    return;
  }
  const auto middle = range.begin() + (range.end() - range.begin()) / 2;
  parallel_invoke([&] { parallel_for(Range(range.begin(), middle, range.grainsize()), body); },
                  [&] { parallel_for(Range(middle, range.end(), range.grainsize()), body); });
}

}  // namespace tbb
