// SPDX-License-Identifier: MIT
// From a tree to the type of its codec: once, at the entry of a query, never per node.
#pragma once

#include <utility>
#include <variant>

#include <boxtree/runtime/tree/tree.h>

namespace boxtree {

/// Calls `visitor` with the codec of `tree`.
template <class Visitor>
decltype(auto) with_codec(const Tree& tree, Visitor&& visitor) {
  return std::visit(std::forward<Visitor>(visitor), tree.codec_view());
}

/// The root box in the scalar of a codec. The cooker stores values of that scalar, so nothing is
/// rounded; a corrupt value only makes a wrong box, and kMaxRootCoordinate keeps it finite.
template <class S>
[[nodiscard]] Box<S> root_box(const Tree& tree) noexcept {
  Box<S> box;
  for (std::size_t k = 0; k < 3; ++k) {
    box.low[k] = static_cast<S>(tree.record().root_low[k]);
    box.high[k] = static_cast<S>(tree.record().root_high[k]);
  }
  return box;
}

}  // namespace boxtree
