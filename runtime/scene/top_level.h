// SPDX-License-Identifier: MIT
// The tree over the static instances of a scene, read from the mapped bytes: nodes of wide8 whose
// leaf n is instance n. Has what the templates of walk/traversal.h need of a tree.
#pragma once

#include "format/codec_wide.h"
#include "format/scene_record.h"
#include "runtime/tree/float_range.h"

namespace boxtree {

/// Boxes of both trees of a scene are compared in the space of this frame.
struct TopLevel {
  using Codec = WideCodec<Wide8Node>;

  SceneRecord scene{};
  Codec codec;

  [[nodiscard]] bool empty() const noexcept { return scene.root == RootKind::kEmpty; }
  [[nodiscard]] bool has_nodes() const noexcept { return scene.root == RootKind::kSubtree; }
  /// Whether it has nodes that filters in single precision may be used for.
  [[nodiscard]] bool has_float_nodes() const noexcept {
    return has_nodes() && is_in_float_range({scene.root_low, scene.root_high});
  }
  [[nodiscard]] bool is_leaf() const noexcept { return scene.root == RootKind::kLeaf; }
  [[nodiscard]] std::uint32_t node_count() const noexcept { return scene.node_count; }
  [[nodiscard]] NodeRef root_ref() const noexcept { return {0, 0}; }
  [[nodiscard]] const Codec& decoder() const noexcept { return codec; }
  /// The number of a leaf's instance.
  [[nodiscard]] std::uint32_t instance(NodeRef leaf) const noexcept {
    return leaf.first / kLeafFaces;
  }
};

/// Largest magnitude of any box coordinate.
[[nodiscard]] inline double max_abs_of(const TopLevel& top) noexcept {
  return max_abs_of(Box<double>{top.scene.root_low, top.scene.root_high}).maxCoeff();
}

/// The root box; writers store f32 values.
template <class S>
[[nodiscard]] Box<S> root_box(const TopLevel& top) noexcept {
  return box_cast<S>(Box<double>{top.scene.root_low, top.scene.root_high});
}

}  // namespace boxtree
