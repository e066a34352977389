// SPDX-License-Identifier: MIT
// Bounds on the work of walks of two trees, and how such walks report the pairs that they find.
//
// Why a walk ends on any bytes, after work that the sizes of the trees bound: in valid files each
// node or leaf of one tree is compared with each of the other at most once, and so is each face.
// The bound on faces limits the work on leaves, as many leaves of a corrupt file may hold the same
// faces.
#pragma once

#include <algorithm>
#include <cstdint>

#include <boxtree/query.h>

#include "format/children.h"
#include "format/codec.h"
#include "format/limits.h"
#include "runtime/tree/bound_tree.h"
#include "runtime/walk/face_copies.h"
#include "runtime/walk/work.h"

namespace boxtree {

/// a * b, or the largest number if that overflows.
[[nodiscard]] constexpr std::uint64_t saturated_product(std::uint64_t a, std::uint64_t b) noexcept {
  return a != 0 && b > ~std::uint64_t{0} / a ? ~std::uint64_t{0} : a * b;
}

/// The most leaves that a tree can have, by its faces and by the children of its nodes.
[[nodiscard]] constexpr std::uint64_t most_leaves(CodecId codec,
                                                  const TreeCounts& counts) noexcept {
  if (is_wide(codec)) return leaves_of(counts.faces_in_leaves);
  return std::min<std::uint64_t>(counts.faces_in_leaves, std::uint64_t{counts.node_count} + 1);
}

/// The most pairs of a node or leaf of one tree with one of the other.
[[nodiscard]] constexpr std::uint64_t most_pairs(CodecId first_codec, const TreeCounts& first,
                                                 CodecId second_codec,
                                                 const TreeCounts& second) noexcept {
  return saturated_product(first.node_count + most_leaves(first_codec, first),
                           second.node_count + most_leaves(second_codec, second));
}

/// Counts the work of one walk of two trees.
class PairBound {
 public:
  PairBound(const BoundTree& first, const BoundTree& second, QueryWork* work) noexcept;

  /// Counts a pair of nodes, or of a node and a leaf, that was expanded; see WalkBound::count.
  [[nodiscard]] Errc count(NodeState state) noexcept { return parts_.count(state); }
  /// Counts a pair of leaves about to be compared.
  [[nodiscard]] Errc compare(NodeRef first, NodeRef second) noexcept {
    const std::uint64_t faces = saturated_product(first.second, second.second);
    if (faces > faces_left_) return Errc::kNodeCorrupt;
    faces_left_ -= faces;
    return Errc::kOk;
  }

 private:
  WalkBound parts_;
  std::uint64_t faces_left_;
};

/// Reports the pairs of faces that touch to a visitor.
class PairReport {
 public:
  PairReport(const BoundTree& first, const BoundTree& second, PairVisitor visitor) noexcept;

  /// Reports two faces, and each copy of the one with each of the other. Returns whether to go on;
  /// see stopped() and error().
  [[nodiscard]] bool add(std::uint32_t first, std::uint32_t second) {
    if (!first_.has_duplicates() && !second_.has_duplicates()) {
      stopped_ = !visitor_({first_refs_(first), second_refs_(second)});
      return !stopped_;
    }
    return report_copies(first, second);
  }

  /// Whether the visitor stopped the walk.
  [[nodiscard]] bool stopped() const noexcept { return stopped_; }
  [[nodiscard]] Errc error() const noexcept { return error_; }

 private:
  [[nodiscard]] bool report_copies(std::uint32_t first, std::uint32_t second);

  const BoundTree& first_;
  const BoundTree& second_;
  LeafFaceRefs first_refs_, second_refs_;
  PairVisitor visitor_;
  std::uint64_t pairs_left_;
  bool stopped_ = false;
  Errc error_ = Errc::kOk;
};

}  // namespace boxtree
