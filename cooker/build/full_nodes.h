// SPDX-License-Identifier: MIT
// Which divisions of leaves make full wide nodes.
//
// A set of leaves whose nodes will be children of a wide node becomes a forest of one or more
// roots. If every node has eight children, each node replaces eight roots by one, so n leaves make
// a forest of r roots if and only if n = r modulo 7. A set that becomes one node is divided into
// the eight roots below that node. A left side of n leaves therefore takes n modulo 7 roots and the
// right side takes the rest. Nearly all divisions of large sets are possible, each with its own
// share of the roots.
#pragma once

#include <algorithm>
#include <cstddef>

#include "format/codec_wide.h"

namespace boxtree::cooker {

/// Number of roots to distribute when a set that becomes `roots` roots is divided.
[[nodiscard]] constexpr std::size_t children_of(std::size_t roots) {
  return roots == 1 ? kWideChildren : roots;
}

/// The number of `roots` that a left side of `left_leaves` of the `leaves` takes; 0 if no number
/// makes its nodes full. The right side takes the remaining roots and all nodes that cannot be
/// full. Precondition: two to eight roots, at least one leaf on either side.
[[nodiscard]] constexpr std::size_t roots_on_left(std::size_t left_leaves, std::size_t leaves,
                                                  std::size_t roots) {
  if (leaves <= roots) return left_leaves;  // each leaf is a root
  const std::size_t left_roots = (left_leaves - 1) % (kWideChildren - 1) + 1;
  return left_roots < roots ? left_roots : 0;
}

/// The possible left side nearest to `left_leaves`. One of seven consecutive sizes is possible.
[[nodiscard]] constexpr std::size_t nearest_full_side(std::size_t left_leaves, std::size_t leaves,
                                                      std::size_t roots) {
  for (std::size_t distance = 0; distance < kWideChildren; ++distance) {
    const std::size_t more = left_leaves + distance;
    if (more < leaves && roots_on_left(more, leaves, roots) != 0) return more;
    if (distance >= left_leaves) continue;
    const std::size_t fewer = left_leaves - distance;
    if (roots_on_left(fewer, leaves, roots) != 0) return fewer;
  }
  return left_leaves;
}

}  // namespace boxtree::cooker
