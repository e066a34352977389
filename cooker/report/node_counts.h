// SPDX-License-Identifier: MIT
// Sizes of encodings that boxtree does not build, counted on the nodes of a built tree: those that
// the paper considers and rejects (sections 2.6, 3.2, 3.2.1 and 5.3), and shrink nodes with one
// cut.
#pragma once

#include <cstdint>

#include "cooker/encode/encoded.h"

namespace boxtree::cooker {

/// Bytes of one tree in various encodings. Cuts are f16 unless stated otherwise.
struct CountedSizes {
  double implicit_slots =
      0;                // of a perfect binary tree with the same depth, leaves in their parents
  double implicit = 0;  // 8 bytes per slot, as in table 2.2

  double whole_bytes_f16 = 0;  // 3.2: fields of 1, 2 or 4 bytes, the least that all numbers fit
  double whole_bytes_f32 = 0;
  double own_sizes = 0;   // 3.2.1: each node as small as its own numbers allow, as in ext2
  double branching4 = 0;  // 5.3: two levels in one node of 32 bytes
  double branching8 = 0;  // three levels in one node of 64 bytes

  double two_cut_shrink = 0;  // packed-f16: shrink nodes with both numbers and cuts
  double one_cut_shrink = 0;  // shrink nodes as two extra kinds, with one number and one cut
};

/// `tree` is in codec plain-f32 and its root is a subtree; `faces` is its number of faces.
[[nodiscard]] CountedSizes count_sizes(const EncodedNodes& tree, std::uint32_t faces);

}  // namespace boxtree::cooker
