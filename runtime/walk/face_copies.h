// SPDX-License-Identifier: MIT
// How answers name faces, and the copies of a face: leaves hold the first of several identical
// ones, and visitors get all of them.
#pragma once

#include <array>
#include <cstdint>

#include <boxtree/query.h>

#include "runtime/tree/bound_tree.h"
#include "runtime/walk/leaf_ids.h"

namespace boxtree {

/// How an answer names face `index` of the tree's order. Precondition: the face exists.
[[nodiscard]] inline FaceRef face_ref(const BoundTree& tree, std::uint32_t index) noexcept {
  return {tree.face_id(index), index};
}

/// The same, unless it is named already.
inline void name(const BoundTree& tree, FaceRef& face) noexcept {
  if (face.id == kNoFaceId) face.id = tree.face_id(face.index);
}

/// Whether face `a` of the tree's order wins a tie against `b`, another part of the face of the
/// source that import split: by their corners, since codecs put the parts in different orders.
[[nodiscard]] bool part_comes_before(const BoundTree& tree, std::uint32_t a,
                                     std::uint32_t b) noexcept;

/// Whether triangle `a_half` of face `a` wins a tie against `b_half` of `b`, both named: by source
/// number, so that every codec and builder agrees. Without numbers they do not.
[[nodiscard]] inline bool comes_before(const BoundTree& tree, const FaceRef& a,
                                       std::uint32_t a_half, const FaceRef& b,
                                       std::uint32_t b_half) noexcept {
  if (a.id != b.id) return a.id < b.id;
  if (a.index == b.index) return a_half < b_half;
  return a.id == kNoFaceId ? a.index < b.index : part_comes_before(tree, a.index, b.index);
}

/// Names faces that come leaf by leaf: reads the ids of a leaf together, when the first is needed.
class LeafFaceRefs {
 public:
  explicit LeafFaceRefs(const BoundTree& tree) noexcept : tree_(tree) {}

  /// See face_ref.
  [[nodiscard]] FaceRef operator()(std::uint32_t index) noexcept {
    if (index / kLeafFaces != leaf_) {
      leaf_ = index / kLeafFaces;
      read_leaf_ids(tree_, leaf_, ids_);
    }
    return {ids_[index % kLeafFaces], index};
  }

 private:
  const BoundTree& tree_;
  std::uint32_t leaf_ = ~std::uint32_t{0};  // whose ids these are
  std::array<std::uint32_t, kLeafFaces> ids_;
};

/// A face that a leaf holds, followed by its copies.
class FaceWithCopies {
 public:
  FaceWithCopies(const BoundTree& tree, std::uint32_t face) noexcept
      : tree_(tree), face_(face), copies_(tree.duplicates_of(face)) {}

  [[nodiscard]] std::uint32_t count() const noexcept { return 1 + copies_.last - copies_.first; }
  /// Precondition: i < count().
  [[nodiscard]] FaceRef face(std::uint32_t i) const noexcept {
    return face_ref(tree_, i == 0 ? face_ : copies_.first + i - 1);
  }

 private:
  const BoundTree& tree_;
  std::uint32_t face_;
  FaceRange copies_;
};

}  // namespace boxtree
