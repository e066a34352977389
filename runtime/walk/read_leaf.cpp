// SPDX-License-Identifier: MIT
#include "runtime/walk/read_leaf.h"

#include "runtime/tree/bound_codec.h"

namespace boxtree {

Errc read_leaf(const BoundTree& tree, NodeRef leaf, TriangleBatch& out) noexcept {
  if constexpr (kWalksTreesByVectors) {
    const LeafReader& reader = tree.leaves();
    const bool is_full = leaf.second == kLeafFaces && leaf.first % kLeafFaces == 0;
    if (is_full && reader.has_clusters() && reader.floats().is_direct &&
        read_leaf_wide(tree, leaf, out)) {
      return Errc::kOk;
    }
  }
  return tree.leaves().read(leaf.first, leaf.second, out);
}

}  // namespace boxtree
