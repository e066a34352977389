// SPDX-License-Identifier: MIT
// Two tasks that meet: ThreadSanitizer has to say so, or its silence elsewhere proves nothing.
#include <cstddef>
#include <vector>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

int main() {
  std::vector<std::size_t> sums(1);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, 1000, 10),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i) sums[0] += i;
                    });
  return sums[0] == 0 ? 1 : 0;
}
