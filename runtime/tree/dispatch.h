// SPDX-License-Identifier: MIT
// From a tree's codec number to the codec's type: once, at the entry of a query, never per node.
#pragma once

#include <concepts>

#include <boxtree/format/codec_plain.h>
#include <boxtree/runtime/tree/tree.h>

namespace boxtree {

/// What a query may ask of a codec. `expand` is the whole of it; see PlainCodec::expand for the
/// promise that makes traversals end on any bytes.
template <class C>
concept Codec = requires(const C& codec, NodeRef ref, const Box<typename C::Scalar>& box,
                         typename C::Children& out) {
  { codec.expand(ref, box, out) }
  noexcept->std::same_as<bool>;
};
static_assert(Codec<PlainCodec<float>> && Codec<PlainCodec<std::uint16_t>>);

/// Calls `visitor` with the codec of `tree`. Tree::bind has refused unknown codecs.
template <class Visitor>
decltype(auto) with_codec(const Tree& tree, Visitor&& visitor) {
  switch (tree.codec()) {
    case CodecId::kPlainF16:
      return visitor(PlainCodec<std::uint16_t>{tree.nodes()});
    case CodecId::kPlainF32:
      break;
  }
  return visitor(PlainCodec<float>{tree.nodes()});
}

/// The root box in the scalar of a codec. The cooker stores values of that scalar, so nothing is
/// rounded; a corrupt value only makes a wrong box.
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
