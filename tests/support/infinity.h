// SPDX-License-Identifier: MIT
// Values that tests of limits share.
#pragma once

#include <limits>

namespace boxtree::test {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

}  // namespace boxtree::test
