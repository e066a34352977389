// SPDX-License-Identifier: MIT
// Which numbers of a transform in a mesh file are taken for what they should be.
#pragma once

#include <cmath>
#include <cstddef>

namespace boxtree::cooker {

/// How far they may be off: numbers with three decimals are common. Khronos' glTF validator takes
/// as much (UNIT_LENGTH_PRECISION).
inline constexpr double kMostOffInTransforms = 0.00769;

/// Of an axis or a quaternion.
[[nodiscard]] inline bool is_unit_length(double length) {
  return std::abs(length - 1) <= kMostOffInTransforms;
}

/// Whether a matrix has that number in a column, 0 to 3, of its last row, 0 0 0 1.
[[nodiscard]] inline bool is_in_last_row(double number, std::size_t column) {
  return std::abs(number - (column == 3 ? 1 : 0)) <= kMostOffInTransforms;
}

}  // namespace boxtree::cooker
