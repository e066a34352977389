// SPDX-License-Identifier: MIT
// Prefetches what a walk will read soon, all of it at once: in a large tree each node and leaf is a
// cache miss, and those of one node's children can be in flight together.
#if defined(BOXTREE_RUNTIME_WALK_PREFETCH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXTREE_RUNTIME_WALK_PREFETCH_INL_H
#undef BOXTREE_RUNTIME_WALK_PREFETCH_INL_H
#else
#define BOXTREE_RUNTIME_WALK_PREFETCH_INL_H
#endif

#include <hwy/cache_control.h>

#include "runtime/tree/bound_tree.h"
#include "runtime/walk/node-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {

/// Only ever touches addresses of the tree's arrays, and those as hints.
template <class Node>
class Prefetch {
 public:
  Prefetch(const BoundTree& tree, const WideCodec<Node>& codec)
      : nodes_(codec.nodes),
        corners_(tree.leaves().mesh().corners),
        clusters_(tree.leaves().clusters()) {
    const MeshArrays& mesh = tree.leaves().mesh();
    if (corners_ != nullptr) {
      face_bytes_ = std::size_t{mesh.corners_per_face} * mesh.corner_bytes;
    }
  }

  /// Whether rays gain by it. Smaller trees are in the caches: there, requesting what comes next
  /// costs mispredicted branches. 4096 nodes are some 200 000 triangles.
  [[nodiscard]] static bool pays(const WideCodec<Node>& codec) { return codec.node_count > 4096; }

  /// Children of a node that are nodes or leaves: bit i is child i. Precondition: the node is
  /// valid.
  HWY_INLINE void nodes(const WideLinks& links, std::uint32_t children) const {
    for (; children != 0; children &= children - 1) {
      const auto child = static_cast<std::uint32_t>(std::countr_zero(children));
      hwy::Prefetch(nodes_ + std::size_t{node_number(links, child)} * sizeof(Node));
    }
  }
  HWY_INLINE void leaves(const WideLinks& links, std::uint32_t children) const {
    constexpr std::size_t kLine = 64;
    for (; children != 0; children &= children - 1) {
      const auto child = static_cast<std::uint32_t>(std::countr_zero(children));
      const std::size_t face = first_face(links, child);
      if (!clusters_.bytes.empty()) {
        const std::uint64_t start =
            load<std::uint32_t>(clusters_.bytes.data(), face / kClusterFaces) * kClusterUnit;
        hwy::Prefetch(clusters_.bytes.data() + std::min(start, clusters_.bytes.size()));
      } else {
        hwy::Prefetch(corners_ + face * face_bytes_);
        hwy::Prefetch(corners_ + face * face_bytes_ + kLine);
      }
    }
  }

 private:
  const std::byte* nodes_;
  const std::byte* corners_;
  const ClusterView& clusters_;
  std::size_t face_bytes_ = 0;
};

}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
