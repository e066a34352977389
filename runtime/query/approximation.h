// SPDX-License-Identifier: MIT
// How near to the truth an answer has to be, and what it may cost.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "runtime/walk/work.h"

namespace boxtree {

/// An answer [lower, upper] is near enough if upper <= lower * (1 + relative_error) or
/// upper <= lower + absolute_error: whichever allows more. Zeros ask for all that double tells.
struct Approximation {
  double relative_error = 0;  // [0] 0 or more
  double absolute_error = 0;  // [0] [length] 0 or more
  /// Nothing farther is looked for [infinity] [length].
  double max_distance = std::numeric_limits<double>::infinity();
  /// Nodes taken apart and leaves read (pairs of them, for two trees) before the query ends with
  /// what it knows [unlimited].
  std::uint64_t node_budget = kUnlimitedNodes;

  /// No NaN, nothing negative.
  [[nodiscard]] bool is_valid() const noexcept {
    return relative_error >= 0 && absolute_error >= 0 && max_distance >= 0;
  }

  /// What need not be looked at, given that some point is `upper` away: all that is known to be as
  /// far as this.
  [[nodiscard]] double enough(double upper) const noexcept {
    if (upper == std::numeric_limits<double>::infinity()) return upper;
    return std::max(0.0, std::min(upper / (1 + relative_error), upper - absolute_error));
  }
};

}  // namespace boxtree
