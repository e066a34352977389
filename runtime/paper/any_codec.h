// SPDX-License-Identifier: MIT
// Dispatches on the codec of a tree, any of them: for tools that observe walks. Queries use
// walk_tree.h.
#pragma once

#include <cstdint>

#include "format/codec_packed.h"
#include "format/codec_plain.h"
#include "format/codec_wide.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree {

/// Calls `visitor` with the codec of the nodes of `tree`; with a codec that has no nodes if the
/// tree has none.
template <class Visitor>
auto with_codec(const BoundTree& tree, const Visitor& visitor) {
  const BoundCodec& nodes = tree.nodes();
  switch (tree.codec_functions().id) {
    case CodecId::kPlainF32:
      return visitor(nodes.as<PlainCodec<float>>());
    case CodecId::kPlainF16:
      return visitor(nodes.as<PlainCodec<std::uint16_t>>());
    case CodecId::kPackedF32:
      return visitor(nodes.as<PackedCodec<PackedCut::kF32>>());
    case CodecId::kPackedF16:
      return visitor(nodes.as<PackedCodec<PackedCut::kF16>>());
    case CodecId::kPackedF64:
      return visitor(nodes.as<PackedCodec<PackedCut::kF64>>());
    case CodecId::kDedup:
      return visitor(nodes.as<PackedCodec<PackedCut::kTable>>());
    case CodecId::kWide8:
      return visitor(nodes.as<WideCodec<Wide8Node>>());
    case CodecId::kWide4:
      return visitor(nodes.as<WideCodec<Wide4Node>>());
  }
  return visitor(PlainCodec<float>());
}

}  // namespace boxtree
