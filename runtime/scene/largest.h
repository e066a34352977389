// SPDX-License-Identifier: MIT
// The largest of numbers that change one at a time.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>

#include "format/memory.h"

namespace boxtree {

/// A complete binary tree: entry 1 is the largest of all, entry n that of entries 2n and 2n + 1.
/// The last half are the numbers, which are not negative.
class Largest {
 public:
  explicit Largest(const Memory* memory) noexcept : largest_(memory) {}
  /// Of `count` numbers, all zero. Allocates.
  Largest(std::size_t count, const Memory* memory)
      : largest_(2 * std::bit_ceil(std::max<std::size_t>(count, 1)), 0.0, memory) {}

  /// Precondition: both are of one memory.
  void swap(Largest& other) noexcept { largest_.swap(other.largest_); }

  /// Precondition: i < count. O(log count), no allocation.
  void set(std::size_t i, double number) noexcept {
    std::size_t at = largest_.size() / 2 + i;
    largest_[at] = number;
    for (at /= 2; at > 0; at /= 2) largest_[at] = std::max(largest_[2 * at], largest_[2 * at + 1]);
  }

  /// Zero of none.
  [[nodiscard]] double of_all() const noexcept { return largest_.empty() ? 0 : largest_[1]; }

 private:
  Array<double> largest_;
};

}  // namespace boxtree
