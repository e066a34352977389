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
  return box_cast<S>(Box<double>{tree.record().root_low, tree.record().root_high});
}

}  // namespace boxtree
