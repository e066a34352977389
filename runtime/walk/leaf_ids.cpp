// SPDX-License-Identifier: MIT
#include "runtime/walk/leaf_ids.h"

#include "runtime/tree/bound_codec.h"

namespace boxtree {

void read_leaf_ids(const BoundTree& tree, std::uint32_t leaf,
                   std::span<std::uint32_t, kLeafFaces> out) noexcept {
  if constexpr (kWalksTreesByVectors) {
    if (const FaceIdView& ids = tree.face_ids()) return read_leaf_ids_wide(ids, leaf, out);
  }
  tree.read_leaf_ids(leaf, out);
}

}  // namespace boxtree
