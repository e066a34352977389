// SPDX-License-Identifier: MIT
// For which trees filters in single precision may be used.
//
// The error bound of a filter holds as long as none of its intermediate results overflows and none
// loses more to underflow than the bound allows for. The largest of them, with R the largest
// coordinate of a tree, E its largest extent and P <= 64 R a query's point:
//   squares of distances          3 (P + R)^2                            < 2^94   (point, sphere)
//   parts of areas                12 E^3 (P + R) and 256 u R E^2 (P + R) < 2^113  (closest point)
//   plane parameters of a ray     2^60 (R + R)                           < 2^101
//   heights of a pair of leaves   48 M^3, M <= 2^40 the largest          < 2^126
//                                 coordinate in either tree's space
// for R <= 2^40 and E <= 2^20. From R = 1 on, errors that are multiples of u R exceed 2^-24 and
// their squares 2^-48, far above what underflow takes from products. Cookers scale the largest
// extent into [2^14, 2^15) and move what is far from the origin there; only surfaces that lie
// within 2^-1000 of each other are out of range. The scalar walks answer for those.
#pragma once

#include <algorithm>

#include "format/box.h"
#include "runtime/tree/frame.h"

namespace boxtree {

/// Largest magnitude of a coordinate, and largest extent, that float filters are proven for.
inline constexpr double kFloatMaxAbs = 0x1p40;
inline constexpr double kFloatExtent = 0x1p20;

/// Exceeds what underflow takes from an affine image: three factors rounded to subnormal numbers,
/// off by 2^-150 each, times coordinates up to kFloatMaxAbs, and seven products and sums.
inline constexpr double kFloatUnderflow = 0x1p-105;

/// Whether float filters may be used for a tree with this root box.
[[nodiscard]] inline bool is_in_float_range(const Box<double>& root) noexcept {
  double extent = 0;
  for (std::size_t k = 0; k < 3; ++k) extent = std::max(extent, root.high[k] - root.low[k]);
  const double max_abs = max_abs_of(root).maxCoeff();
  return 1 <= max_abs && max_abs <= kFloatMaxAbs && extent <= kFloatExtent;
}

}  // namespace boxtree
