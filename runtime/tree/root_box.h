// SPDX-License-Identifier: MIT
// Where a walk begins: the box of the root, in the scalar of the walk.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

#include "runtime/tree/bound_tree.h"

namespace boxtree {

/// The smallest box in another scalar that holds `exact`.
template <class S>
[[nodiscard]] Box<S> rounded_outward(const Box<double>& exact) noexcept {
  Box<S> box = box_cast<S>(exact);
  constexpr S kInfinity = std::numeric_limits<S>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    if (box.low[k] > exact.low[k]) box.low[k] = std::nextafter(box.low[k], -kInfinity);
    if (box.high[k] < exact.high[k]) box.high[k] = std::nextafter(box.high[k], kInfinity);
  }
  return box;
}

/// The root box in the scalar of a codec, rounded outward. A corrupt value only makes a wrong box,
/// and kMaxRootCoordinate keeps it finite.
template <class S>
[[nodiscard]] Box<S> root_box(const BoundTree& tree) noexcept {
  if constexpr (std::is_same_v<S, float>) {
    return tree.root_f32();
  } else {
    return tree.root_f64();
  }
}

}  // namespace boxtree
