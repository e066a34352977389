// SPDX-License-Identifier: MIT
// A codec that stands for any other: for trees in different codecs, and for walks whose time goes
// into something else than finding out the codec at each node.
#pragma once

#include <cstddef>
#include <cstdint>

#include "runtime/tree/bound_tree.h"
#include "runtime/tree/dispatch.h"

namespace boxtree {

/// Any codec, found out at every node, so that the number of instantiations grows neither with the
/// codecs nor with their square.
template <std::size_t Width>
struct ErasedCodecOf {
  using Scalar = double;
  using Children = ChildSet<Width, double>;
  static constexpr std::uint32_t kDepthLimit = kMaxDepth;

  const BoundTree* tree;

  static Result<ErasedCodecOf> bind(const TreeRecord&, Bytes) { return Errc::kInternal; }
  [[nodiscard]] NodeRef root(const TreeRecord&) const noexcept { return tree->root_ref(); }

  // Boxes of f32 codecs come and go through double unchanged.
  [[nodiscard]] bool expand(NodeRef ref, const Box<double>& box, Children& out) const noexcept {
    return with_codec(*tree, [&]<class C>([[maybe_unused]] const C& codec) {
      if constexpr (C::Children::kWidth > Width) {
        return false;
      } else {
        typename C::Children children;
        if (!codec.expand(ref, box_cast<typename C::Scalar>(box), children)) return false;
        out.count = children.count;
        out.leaf_mask = children.leaf_mask;
        for (std::uint32_t i = 0; i < children.count; ++i) {
          for (std::size_t k = 0; k < 3; ++k) {
            out.low[k][i] = children.low[k][i];
            out.high[k][i] = children.high[k][i];
          }
          out.ref[i] = children.ref[i];
        }
        return true;
      }
    });
  }
};
using ErasedCodec = ErasedCodecOf<kWideChildren>;
/// For trees of binary codecs. Pair walks take both of their nodes apart at once.
using ErasedBinaryCodec = ErasedCodecOf<2>;

}  // namespace boxtree
