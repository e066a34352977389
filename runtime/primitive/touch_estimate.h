// SPDX-License-Identifier: MIT
// About when a moving sphere or capsule touches a triangle, in closed form and without any bound:
// where a search begins that proves what it finds.
#pragma once

#include <limits>

#include "runtime/primitive/convex_shape.h"

namespace boxtree {

struct TouchEstimate {
  double s = std::numeric_limits<double>::infinity();
  CoreGuess core = CoreGuess::kNone;  // of a capsule: what of it touches
};

/// By how much a sphere or capsule that is in the origin has to move along `direction` to touch;
/// infinity where it seems not to. Where it touches already, anything.
[[nodiscard]] TouchEstimate estimated_touch(const ConvexShape& shape,
                                            const Eigen::Vector3d& direction,
                                            const Corners& corner) noexcept;

}  // namespace boxtree
