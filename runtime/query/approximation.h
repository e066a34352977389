// SPDX-License-Identifier: MIT
// What an allowed error means for a search.
#pragma once

#include <algorithm>
#include <limits>

#include <boxtree/query.h>

namespace boxtree {

/// The first field that is NaN or negative; null if there is none. As the details of all invalid
/// queries, it is short enough for a std::string to take without allocating.
[[nodiscard]] const char* invalid_field(const Approximation& approximation) noexcept;

/// The distance from which candidates can be skipped, given that some point is `upper` away.
[[nodiscard]] inline double converged_beyond(const Approximation& approximation,
                                             double upper) noexcept {
  if (upper == std::numeric_limits<double>::infinity()) return upper;
  return std::max(0.0, std::min(upper / (1 + approximation.relative_error),
                                upper - approximation.absolute_error));
}

}  // namespace boxtree
