// SPDX-License-Identifier: MIT
// The decoded box: what a reader computes from the stored bits.
#pragma once

#include <array>

namespace boxtree {

/// Closed axis-aligned box in tree space (see TreeRecord). S is float, or double for f64 codecs.
template <class S>
struct Box {
  std::array<S, 3> low;
  std::array<S, 3> high;

  friend bool operator==(const Box&, const Box&) = default;
};

}  // namespace boxtree
