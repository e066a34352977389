// SPDX-License-Identifier: MIT
// Simultaneous descent of two trees (Zachmann, "The BoxTree", 1995; paper section 1.1), over any
// pair of codecs. Implements <boxtree/contact.h>; measurements use it directly, with an observer.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "runtime/query/leaf_pairs.h"
#include "runtime/query/pair_work.h"
#include "runtime/query/relative_pose.h"
#include "runtime/tree/bound_tree.h"
#include "runtime/walk/traversal.h"

namespace boxtree {

/// Observes a pair walk; this one does nothing and costs nothing.
struct NoPairObserver {
  /// A pair of nodes, not both leaves, is about to be expanded.
  void node_pair(NodeRef, bool /*first_is_leaf*/, NodeRef, bool /*second_is_leaf*/) noexcept {}
  /// The triangles of two leaves are about to be compared.
  void leaf_pair(NodeRef, NodeRef) noexcept {}
  // If it has a member kCountsLeafPairs, that is all: their triangles are neither read nor
  // compared. If it has members `bool stops(first_box, second_box)` and `bool stops(triangle,
  // moved)`, the walk calls them to see whether to end: the first before either of the above; the
  // second with each triangle of the first leaf and of the second, moved into the first one's
  // space, that do not touch.
};

/// The children of one side of a pair: those of a node, or the leaf itself.
template <NodeDecoder C>
struct PairSide {
  typename C::Children children;
  std::array<Box<double>, C::Children::kWidth> image;  // in the other tree's space

  void set_leaf(const Box<typename C::Scalar>& box, NodeRef ref) noexcept {
    children.clear();
    children.add(box, ref, true);
  }
};

/// One test of two trees. Everything passed by reference must outlive it.
template <NodeDecoder A, NodeDecoder B, class Observer = NoPairObserver>
class PairWalk {
 public:
  PairWalk(const BoundTree& first, const A& first_codec, const BoundTree& second,
           const B& second_codec, const RelativePose& pose, PairVisitor visitor, PairBound& bound,
           Observer observer = {}) noexcept
      : first_(first),
        second_(second),
        first_codec_(first_codec),
        second_codec_(second_codec),
        pose_(pose),
        observer_(observer),
        bound_(bound),
        leaves_(first, second, pose, visitor) {}

  [[nodiscard]] Result<Visit> run() {
    if (first_.empty() || second_.empty()) return Visit::kComplete;
    const Entry root{root_box<typename A::Scalar>(first_),
                     root_box<typename B::Scalar>(second_),
                     first_.root_ref(),
                     second_.root_ref(),
                     first_.is_leaf(),
                     second_.is_leaf()};
    const bool apart = !boxes_overlap(root.first_box, pose_.hull_in_first(root.second_box)) ||
                       !boxes_overlap(pose_.hull_in_second(root.first_box), root.second_box);
    if (!apart && (root.first_leaf && root.second_leaf)) {
      test_leaves(root);
    } else if (!apart) {
      error_ = stack_.push(root);
    }
    while (!stack_.empty() && error_ == Errc::kOk && !stopped_) descend(stack_.pop());
    if (error_ != Errc::kOk) return error_;
    return stopped_ ? Visit::kStopped : Visit::kComplete;
  }

 private:
  struct Entry {
    Box<typename A::Scalar> first_box;
    Box<typename B::Scalar> second_box;
    NodeRef first;
    NodeRef second;
    bool first_leaf;
    bool second_leaf;
  };

  // Binary nodes: both sides are expanded at once, a path ends after as many steps as the deeper
  // tree has levels, and each step leaves all but one of its child pairs pending. Wide nodes: one
  // side is expanded at a time, so that a step compares eight boxes with one and not with eight.
  static constexpr std::size_t kPairs = A::Children::kWidth * B::Children::kWidth;
  static constexpr bool kBothSides = kPairs <= 4;
  static constexpr std::size_t kPairStack =
      kBothSides ? kMaxDepth * (kPairs - 1) + 1
                 : A::kDepthLimit * (A::Children::kWidth - 1) +
                       B::kDepthLimit * (B::Children::kWidth - 1) + 1;

  template <class First, class Second>
  [[nodiscard]] bool stops(const First& first, const Second& second) noexcept {
    if constexpr (requires { observer_.stops(first, second); }) {
      stopped_ = observer_.stops(first, second);
    }
    return stopped_;
  }

  void descend(const Entry entry) {
    if (stops(entry.first_box, entry.second_box)) return;
    observer_.node_pair(entry.first, entry.first_leaf, entry.second, entry.second_leaf);
    if constexpr (kBothSides) {
      descend_both(entry);
    } else {
      descend_one(entry);
    }
  }

  // The larger box is expanded, a leaf never. A pair (a, b) is visited once: only one of the pairs
  // (parent of a, b) and (a, parent of b) arises, the one that their common parent pair chose.
  void descend_one(const Entry& entry) {
    const Box<double> second_image = pose_.hull_in_first(entry.second_box);
    if (!entry.first_leaf &&
        (entry.second_leaf || extent(entry.first_box) > extent(second_image))) {
      auto& children = first_side_.children;
      error_ = bound_.count(first_codec_.expand(entry.first, entry.first_box, children));
      if (error_ != Errc::kOk) return;
      for (std::uint32_t i = 0; i < children.count && error_ == Errc::kOk && !stopped_; ++i) {
        const Box<typename A::Scalar> box = children.box(i);
        if (!boxes_overlap(box, second_image) ||
            !boxes_overlap(pose_.hull_in_second(box), entry.second_box)) {
          continue;
        }
        intersect({box, entry.second_box, children.ref[i], entry.second, children.is_leaf(i),
                   entry.second_leaf});
      }
      return;
    }
    const Box<double> first_image = pose_.hull_in_second(entry.first_box);
    auto& children = second_side_.children;
    error_ = bound_.count(second_codec_.expand(entry.second, entry.second_box, children));
    if (error_ != Errc::kOk) return;
    for (std::uint32_t i = 0; i < children.count && error_ == Errc::kOk && !stopped_; ++i) {
      const Box<typename B::Scalar> box = children.box(i);
      if (!boxes_overlap(first_image, box) ||
          !boxes_overlap(entry.first_box, pose_.hull_in_first(box))) {
        continue;
      }
      intersect({entry.first_box, box, entry.first, children.ref[i], entry.first_leaf,
                 children.is_leaf(i)});
    }
  }

  template <class S>
  [[nodiscard]] static double extent(const Box<S>& box) noexcept {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += double{box.high[k]} - double{box.low[k]};
    return sum;
  }

  // Handles a pair whose boxes overlap: compares two leaves, pushes anything else.
  void intersect(const Entry& entry) {
    if (entry.first_leaf && entry.second_leaf) {
      test_leaves(entry);
    } else {
      error_ = stack_.push(entry);
    }
  }

  void descend_both(const Entry& entry) {
    const NodeState first =
        expand(first_codec_, entry.first_leaf, entry.first_box, entry.first, first_side_);
    const NodeState second =
        expand(second_codec_, entry.second_leaf, entry.second_box, entry.second, second_side_);
    error_ = bound_.count(first == NodeState::kValid ? second : first);
    if (error_ != Errc::kOk) return;
    const auto& a = first_side_.children;
    const auto& b = second_side_.children;
    for (std::uint32_t i = 0; i < a.count; ++i) {
      first_side_.image[i] = pose_.hull_in_second(a.box(i));
    }
    for (std::uint32_t j = 0; j < b.count; ++j) {
      second_side_.image[j] = pose_.hull_in_first(b.box(j));
    }
    for (std::uint32_t i = 0; i < a.count; ++i) {
      for (std::uint32_t j = 0; j < b.count; ++j) {
        if (!boxes_overlap(a.box(i), second_side_.image[j]) ||
            !boxes_overlap(first_side_.image[i], b.box(j))) {
          continue;
        }
        intersect({a.box(i), b.box(j), a.ref[i], b.ref[j], a.is_leaf(i), b.is_leaf(j)});
        if (error_ != Errc::kOk || stopped_) return;
      }
    }
  }

  template <NodeDecoder C>
  [[nodiscard]] static NodeState expand(const C& codec, bool leaf,
                                        const Box<typename C::Scalar>& box, NodeRef ref,
                                        PairSide<C>& side) noexcept {
    if (!leaf) return codec.expand(ref, box, side.children);
    side.set_leaf(box, ref);
    return NodeState::kValid;
  }

  void test_leaves(const Entry& entry) {
    if (stops(entry.first_box, entry.second_box)) return;
    error_ = bound_.compare(entry.first, entry.second);
    if (error_ != Errc::kOk) return;
    observer_.leaf_pair(entry.first, entry.second);
    if constexpr (requires { Observer::kCountsLeafPairs; }) return;
    const LeafPair leaves{box_cast<double>(entry.first_box), box_cast<double>(entry.second_box),
                          entry.first, entry.second};
    if constexpr (requires(const Triangle& t) { observer_.stops(t, t); }) {
      const auto watched = [this](const Triangle& first, const Triangle& moved) {
        return observer_.stops(first, moved);
      };
      const TriangleWatch watch = watched;
      error_ = leaves_.run(leaves, &watch);
    } else {
      error_ = leaves_.run(leaves, nullptr);
    }
    stopped_ = leaves_.stopped();
  }

  const BoundTree& first_;
  const BoundTree& second_;
  const A first_codec_;
  const B second_codec_;
  const RelativePose& pose_;
  [[no_unique_address]] Observer observer_;
  PairBound& bound_;
  Errc error_ = Errc::kOk;
  bool stopped_ = false;
  PairSide<A> first_side_;
  PairSide<B> second_side_;
  LeafPairTest leaves_;
  WalkStack<Entry, kPairStack> stack_;
};

/// The walk by vectors. Precondition: both trees have nodes of the same wide codec.
Result<Visit> walk_wide_pairs(const BoundTree& first, const BoundTree& second,
                              const RelativePose& pose, PairVisitor visitor, PairBound& bound);

}  // namespace boxtree
