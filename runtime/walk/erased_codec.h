// SPDX-License-Identifier: MIT
// A codec that wraps any other: for trees in different codecs, and for walks in which an indirect
// call per node costs little.
#pragma once

#include <cstddef>
#include <cstdint>

#include "runtime/tree/bound_tree.h"

namespace boxtree {

/// Any codec through its functions, one indirect call per node, so that the number of
/// instantiations grows neither with the codecs nor with their square.
template <std::size_t Width>
struct ErasedCodecOf {
  using Scalar = double;
  using Children = ChildSet<Width, double>;
  static constexpr std::uint32_t kDepthLimit = kMaxDepth;

  const BoundTree* tree;

  // Also kCorrupt when a node has more children than there is room for.
  [[nodiscard]] NodeState expand(NodeRef ref, const Box<double>& box,
                                 Children& out) const noexcept {
    const CodecFunctions& functions = tree->codec_functions();
    if constexpr (Width == AnyChildren::kWidth) {
      return functions.expand(tree->nodes(), ref, box, out);
    } else {
      AnyChildren children;
      const NodeState state = functions.expand(tree->nodes(), ref, box, children);
      if (state != NodeState::kValid || children.count > Width) return NodeState::kCorrupt;
      out.clear();
      for (std::uint32_t i = 0; i < children.count; ++i) {
        out.add(children.box(i), children.ref[i], children.is_leaf(i));
      }
      return state;
    }
  }
};
using ErasedCodec = ErasedCodecOf<kWideChildren>;
/// For trees of binary codecs. Pair walks expand both of their nodes at once.
using ErasedBinaryCodec = ErasedCodecOf<2>;

}  // namespace boxtree
