// SPDX-License-Identifier: MIT
// Which divisions of leaves make full wide nodes.
//
// A set of leaves on its way to be children of a wide node becomes a forest, of one root or more.
// Where every node has eight children, each takes eight roots and leaves one, so that n leaves make
// a forest of r roots if and only if n = r modulo 7. A set that becomes one node is divided as the
// eight roots below it. So a left side of n leaves calls for n modulo 7 roots, and the right side
// for the rest: nearly all divisions of large sets are open, each with its own share of the roots.
#pragma once

#include <algorithm>
#include <cstddef>

#include "format/codec_wide.h"

namespace boxtree::cooker {

/// Roots that a set has to share out when it is divided.
[[nodiscard]] constexpr std::size_t children_of(std::size_t roots) {
  return roots == 1 ? kWideChildren : roots;
}

/// How many of `roots` fall to a left side of so many of the leaves; 0 if no number makes its nodes
/// full. The right side keeps what is left, and so all nodes that cannot be full.
/// Precondition: two roots to eight, at least one leaf on either side.
[[nodiscard]] constexpr std::size_t roots_on_left(std::size_t left_leaves, std::size_t leaves,
                                                  std::size_t roots) {
  if (leaves <= roots) return left_leaves;  // each leaf is a root
  const std::size_t left_roots = (left_leaves - 1) % (kWideChildren - 1) + 1;
  return left_roots < roots ? left_roots : 0;
}

/// The left side nearest to `left_leaves` that has such a number. One of seven in a row has.
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
