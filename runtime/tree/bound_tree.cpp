// SPDX-License-Identifier: MIT
// A bound tree: its root, and what lies below a node.
#include "runtime/tree/bound_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include "format/message.h"

namespace boxtree {

const BoundTree& BoundTree::of(const Tree& tree) noexcept {
  static_assert(sizeof(BoundTree) <= Tree::kBytes && alignof(BoundTree) <= alignof(Tree));
  return *std::launder(reinterpret_cast<const BoundTree*>(tree.storage_));
}

BoundTree& BoundTree::inside(Tree& tree) noexcept {
  return *std::launder(reinterpret_cast<BoundTree*>(tree.storage_));
}

bool BoundTree::has_face_ids() const noexcept {
  return bool{face_ids_} || is_in_source_order_;
}

std::uint32_t BoundTree::face_id(std::uint32_t face) const noexcept {
  if (face_ids_) return face_ids_[face];
  return is_in_source_order_ ? face : kNoFaceId;
}

FaceRef BoundTree::with_id(const FaceRef& face) const noexcept {
  if (face.id != kNoFaceId || face.index >= face_count_) return face;
  return {face_id(face.index), face.index};
}

void BoundTree::read_leaf_ids(std::uint32_t leaf,
                              std::span<std::uint32_t, kLeafFaces> out) const noexcept {
  if (face_ids_) return face_ids_.read_leaf(leaf, out);
  for (std::uint32_t i = 0; i < kLeafFaces; ++i) {
    out[i] = is_in_source_order_ ? leaf * kLeafFaces + i : kNoFaceId;
  }
}

NodeRef BoundTree::root_ref() const noexcept {
  return is_leaf() ? NodeRef{0, counts_.faces_in_leaves} : functions_->root(nodes_);
}

Node BoundTree::root() const noexcept {
  return {root_f64_, root_ref(), is_leaf()};
}

NodeState BoundTree::expand(const Node& node, NodeChildren& out) const noexcept {
  out.count = 0;
  AnyChildren children;
  const NodeState state = functions_->expand(nodes_, node.ref, node.box, children);
  if (state != NodeState::kValid) return state;
  for (std::uint32_t i = 0; i < children.count; ++i) {
    out.child[i] = {children.box(i), children.ref[i], children.is_leaf(i)};
  }
  out.count = children.count;
  return state;
}

Errc BoundTree::leaf_triangles(const Node& leaf, TriangleBatch& out) const noexcept {
  return leaves_.read(leaf.ref.first, leaf.ref.second, out);
}

Result<Triangle> BoundTree::triangle(const FaceRef& face, std::uint32_t half) const {
  if (face.index >= face_count_) {
    return error_with(Errc::kInvalidQuery, {}, "face # of #", {face.index, face_count_});
  }
  TriangleBatch batch;
  // Copies are equal to the last bit, so one reading serves them all.
  const Errc error = leaves_.read(original_of(face.index), 1, batch);
  if (error != Errc::kOk) return error;
  if (half >= batch.count) {
    return error_with(Errc::kInvalidQuery, {}, "half # of face #, which has #",
                      {half, face.index, batch.count});
  }
  return batch.triangle(half);
}

FaceRange BoundTree::duplicates_of(std::uint32_t face) const noexcept {
  const std::uint32_t originals = counts_.faces_in_leaves;
  if (!duplicates_) return {originals, originals};
  // The first whose original is not below `limit`.
  const auto from = [this](std::uint32_t limit) {
    std::uint32_t low = 0;
    std::uint32_t high = duplicate_count();
    while (low < high) {
      const std::uint32_t middle = low + (high - low) / 2;
      const bool below = duplicates_[middle] < limit;
      (below ? low : high) = below ? middle + 1 : middle;
    }
    return low;
  };
  const std::uint32_t first = from(face);
  return {originals + first, originals + std::max(first, from(face + 1))};
}

std::uint32_t BoundTree::original_of(std::uint32_t face) const noexcept {
  const std::uint32_t originals = counts_.faces_in_leaves;
  return duplicates_ && face >= originals ? duplicates_[face - originals] : face;
}

Eigen::AlignedBox3d BoundTree::to_object(const Box<double>& box) const noexcept {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Eigen::Vector3d low;
  Eigen::Vector3d high;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    low[axis] = box.low[k] * frame_.scale;
    high[axis] = box.high[k] * frame_.scale;
    if (frame_.origin[axis] == 0) continue;  // scaling by a power of two did not round
    // Two roundings: a position whose difference from the origin was rounded into the box may lie
    // less than an ulp of that difference outside, far more than one of its own near zero; and
    // adding the origin rounds again.
    low[axis] = std::nextafter(low[axis], -kInfinity) + frame_.origin[axis];
    high[axis] = std::nextafter(high[axis], kInfinity) + frame_.origin[axis];
    low[axis] = std::nextafter(low[axis], -kInfinity);
    high[axis] = std::nextafter(high[axis], kInfinity);
  }
  return {low, high};
}

}  // namespace boxtree
