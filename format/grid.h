// SPDX-License-Identifier: MIT
// Grids that positions may be rounded to.
#pragma once

namespace boxtree {

/// Bits of a grid over the largest extent: the range that writers offer and readers rely on.
inline constexpr int kMinGridBits = 8;
inline constexpr int kMaxGridBits = 30;

}  // namespace boxtree
