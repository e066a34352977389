// SPDX-License-Identifier: MIT
// A walk from near to far over nodes of a wide codec, which queues leaves among the nodes: for
// queries whose leaves cost as much as a node or more.
#if defined(BOXTREE_RUNTIME_WALK_NEAREST_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXTREE_RUNTIME_WALK_NEAREST_INL_H
#undef BOXTREE_RUNTIME_WALK_NEAREST_INL_H
#else
#define BOXTREE_RUNTIME_WALK_NEAREST_INL_H
#endif

#include <array>

#include "runtime/walk/decode-inl.h"
#include "runtime/walk/traversal_stack-inl.h"
#include "runtime/walk/work.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
#if HWY_TARGET != HWY_SCALAR

/// What the walk needs of `Query`:
/// query.intersect(const VectorBox&, FloatVector& key) -> bits of the boxes that can matter, and
///   their keys, which are not negative.
/// query.bound() -> float: keys above it cannot improve the answer.
/// query.expanding(const WideLinks&, std::uint32_t passing): a node was expanded; its children
///   `passing` were pushed.
/// query.nodes() -> WalkBound&: of as many nodes as the codec has.
/// query.reads_ahead() -> bool: whether leaf() wants to know `next`.
/// query.leaf(number, next) -> bool: whether to go on; the query keeps its own error. `next`: the
///   leaf that is visited next unless the bound excludes it by then, or kNoLeaf.
template <class Node, class Query>
class NearestWalk {
 public:
  NearestWalk(const WideCodec<Node>& codec, Query& query) : codec_(codec), query_(query) {}

  /// `root`: the box of node 0. Returns kNodeCorrupt or kDepthExceeded for corrupt nodes;
  /// kWorkLimit.
  Errc run(const Box<float>& root) {
    // The children of a node at depth n are in open_[n].
    Box<float> box = root;
    std::size_t depth = 0;
    std::uint32_t number = 0;
    for (;;) {
      const NodeView<Node> node(codec_, number);
      const WideLinks links = node.links();
      const Errc error = query_.nodes().count(check_links(codec_, number, links));
      if (error != Errc::kOk) return error;
      if (depth == open_.size()) return Errc::kDepthExceeded;
      open_[depth].links = links;
      query_.expanding(
          links, intersect(node, box, open_[depth].boxes, depth, (1u << links.child_count) - 1));
      for (;;) {
        typename decltype(stack_)::Child at;
        if (!stack_.pop(query_.bound(), at)) return Errc::kOk;
        const Children& of = open_[at.depth];
        if (((of.links.inner_mask >> at.number) & 1u) != 0) {
          box = of.boxes.box(at.number);
          number = node_number(of.links, at.number);
          depth = at.depth + 1;
          break;
        }
        if (!query_.leaf(leaf_number(of.links, at.number), next_leaf())) return Errc::kOk;
      }
    }
  }

 private:
  struct Children {
    ChildBoxes boxes;
    WideLinks links;
  };

  // Pushes those of a node's children that can matter; bit i is child i.
  HWY_INLINE std::uint32_t intersect(const NodeView<Node>& node, const Box<float>& box,
                                     ChildBoxes& children, std::size_t depth, std::uint32_t all) {
    HWY_ALIGN float keys[kWideChildren];
    std::uint32_t passing = 0;
    for (std::size_t part = 0; part < kParts; ++part) {
      FloatVector key;
      passing |= query_.intersect(decode(node, box, part, children), key) << (part * kLanes);
      hn::Store(key, Floats(), keys + part * kLanes);
    }
    passing &= all;
    stack_.push(passing, keys, depth);
    return passing;
  }

  // What is on top of the stack, if it is a leaf and the query wants to know.
  HWY_INLINE std::uint32_t next_leaf() const {
    typename decltype(stack_)::Child top;
    if (!query_.reads_ahead() || !stack_.top(query_.bound(), top)) return kNoLeaf;
    const WideLinks& links = open_[top.depth].links;
    return ((links.inner_mask >> top.number) & 1u) != 0 ? kNoLeaf : leaf_number(links, top.number);
  }

  const WideCodec<Node>& codec_;
  Query& query_;
  TraversalStack<WideCodec<Node>::kDepthLimit> stack_;
  std::array<Children, WideCodec<Node>::kDepthLimit> open_;
};

#endif
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
