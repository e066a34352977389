// SPDX-License-Identifier: MIT
// A codec that stands for any other: how trees in different codecs meet.
#pragma once

#include <boxtree/runtime/tree/tree.h>

namespace boxtree {

/// Any codec, found out at every node: for trees in different codecs, so that the number of
/// instantiations grows with the codecs and not with their square.
struct ErasedCodec {
  using Scalar = double;
  using Children = ChildSet<kWideChildren, double>;
  static constexpr std::uint32_t kDepthLimit = kMaxDepth;

  const Tree* tree;

  static Result<ErasedCodec> bind(const TreeRecord&, Bytes) { return Errc::kInternal; }
  [[nodiscard]] NodeRef root(const TreeRecord&) const noexcept { return tree->root_ref(); }

  // Boxes of f32 codecs come and go through double unchanged.
  [[nodiscard]] bool expand(NodeRef ref, const Box<double>& box, Children& out) const noexcept {
    NodeChildren children;
    if (tree->expand({box, ref, false}, children) != Errc::kOk) return false;
    out.clear();
    for (std::uint32_t i = 0; i < children.count; ++i) {
      const Node& child = children.child[i];
      out.add(child.box, child.ref, child.is_leaf);
    }
    return true;
  }
};

}  // namespace boxtree
