// SPDX-License-Identifier: MIT
// What an allowed error means for a search.
#pragma once

#include <algorithm>
#include <limits>

#include <boxtree/query.h>

namespace boxtree {

/// The distance from which candidates can be skipped, given that some point is `upper` away.
[[nodiscard]] inline double converged_beyond(const Approximation& approximation,
                                             double upper) noexcept {
  if (upper == std::numeric_limits<double>::infinity()) return upper;
  return std::max(0.0, std::min(upper / (1 + approximation.relative_error),
                                upper - approximation.absolute_error));
}

}  // namespace boxtree
