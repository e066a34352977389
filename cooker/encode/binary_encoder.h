// SPDX-License-Identifier: MIT
// The walk behind every binary codec: from the build tree to nodes with cuts, carrying the decoded
// box that a reader will see and cutting only as far as that box allows. What a node looks like is
// the sink's business.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <boxtree/cooker/encode/encoded.h>
#include <boxtree/cooker/encode/visit_cost.h>
#include <boxtree/format/binary_node.h>
#include <boxtree/format/limits.h>

namespace boxtree::cooker {

/// The paper's threshold: an empty slab is cut off when it holds at least this share of the box.
inline constexpr double kShrinkShare = 0.15;

/// Levels of nodes that stand together before the walk turns to the subtrees below them, so that a
/// descent reads few pages: 2^8 nodes of 16 bytes are a page of 4096.
inline constexpr std::uint32_t kClusterLevels = 8;

/// The largest cut for which the reader's plane, fl(plane - cut), is not below `bound`. The first
/// guess is off by rounding only; cut 0 always satisfies, so the loop ends. Never -0, which would
/// be a second way to store 0.
template <class S>
[[nodiscard]] S largest_cut_down(S plane, S bound) {
  S cut = plane - bound;
  while (plane - cut < bound) cut = std::nextafter(cut, S{0});
  return cut + S{0};
}

/// The same for a plane that moves up: fl(plane + cut) is not above `bound`.
template <class S>
[[nodiscard]] S largest_cut_up(S plane, S bound) {
  S cut = bound - plane;
  while (plane + cut > bound) cut = std::nextafter(cut, S{0});
  return cut + S{0};
}

/// Where a sink put a node.
struct NodePlace {
  NodeKind kind;
  std::uint32_t number;  // in the terms of the sink
};

/// Axis and cuts of a node; a missing child has cut 0.
template <class S>
struct Cuts {
  std::size_t axis = 0;
  S cut[2] = {};
};

/// Sink:
///   Scalar                          float or double: the reader's arithmetic
///   static Scalar storable(Scalar)  the largest storable cut that is not larger
///   NodePlace add(NodeKind, const Cuts<Scalar>&)    appends a node without children
///   void set_leaf(NodePlace, side, face)
///   void set_subtree(NodePlace, side, NodePlace)
/// Bounds: a callable, node of the build tree -> Box<Scalar> of what is below it.
template <class Sink, class Bounds>
class BinaryEncoder {
 public:
  using S = typename Sink::Scalar;

  BinaryEncoder(const BuildTree& tree, FaceOrder order, Bounds bounds, Sink& sink)
      : tree_(tree), order_(order), bounds_(bounds), sink_(sink) {}

  /// Encodes the whole tree and returns all but the bytes. The root is the first node added.
  EncodedNodes run() {
    EncodedNodes out;
    if (tree_.nodes.empty()) return out;
    const Box<S> root = bounds_(0);
    for (std::size_t k = 0; k < 3; ++k) {
      out.root_box.low[k] = root.low[k];
      out.root_box.high[k] = root.high[k];
    }
    out.root = RootKind::kLeaf;
    out.leaf_count = 1;
    if (tree_.nodes[0].is_leaf()) return out;
    out.root = RootKind::kSubtree;
    out.leaf_count = static_cast<std::uint32_t>((tree_.nodes.size() + 1) / 2);
    cost_ = VisitCost(root);
    add_cluster({0, 0, root, 0});
    out.node_count = node_count_;
    out.shrink_count = shrink_count_;
    out.depth = depth_;
    out.visits = cost_.visits();
    return out;
  }

 private:
  // A subtree to encode: its node of the build tree, the leaves before it, the box that a reader
  // decodes for it and the nodes above it.
  struct Item {
    std::uint32_t source;
    std::uint32_t leaves_before;
    Box<S> box;
    std::uint32_t depth;
  };
  // A subtree that was left for later: its parent is waiting for its place.
  struct Pending {
    Item item;
    NodePlace parent;
    std::size_t side;
  };

  // Adds the top levels of a subtree in preorder, then one after the other all that hangs below.
  // Recursion is as deep as the tree, which kMaxDepth bounds.
  NodePlace add_cluster(const Item& item) {
    std::vector<Pending> pending;
    const NodePlace place = add_subtree(item, kClusterLevels, pending);
    for (const Pending& below : pending) {
      sink_.set_subtree(below.parent, below.side, add_cluster(below.item));
    }
    return place;
  }

  NodePlace add_subtree(const Item& item, std::uint32_t levels, std::vector<Pending>& pending) {
    cost_.add(item.box);
    depth_ = std::max(depth_, item.depth + 1);
    ++node_count_;
    const BuildNode& build = tree_.nodes[item.source];
    const Box<S> content = bounds_(item.source);
    if (const Shrink shrink = find_shrink(item, content); shrink.worth) {
      ++shrink_count_;
      const NodePlace place = sink_.add(NodeKind::kNoLeaves, shrink.cuts);
      add_child(place, shrink.side, {item.source, item.leaves_before, shrink.box, item.depth},
                levels, pending);
      return place;
    }
    const std::uint32_t left = item.source + 1;
    const std::uint32_t right = build.right;
    Cuts<S> cuts;
    cuts.axis = build.axis();
    const std::size_t axis = cuts.axis;
    cuts.cut[0] = Sink::storable(largest_cut_down(item.box.high[axis], bounds_(left).high[axis]));
    cuts.cut[1] = Sink::storable(largest_cut_up(item.box.low[axis], bounds_(right).low[axis]));
    const NodePlace place = sink_.add(kind_of(left, right), cuts);
    // A subtree of n leaves has 2n - 1 nodes, so the place of the right one counts the left leaves.
    const std::uint32_t left_leaves = (right - item.source) / 2;
    add_child(place, 0,
              {left, item.leaves_before, child_box(item.box, axis, 0, cuts.cut[0]), item.depth},
              levels, pending);
    add_child(place, 1,
              {right, item.leaves_before + left_leaves, child_box(item.box, axis, 1, cuts.cut[1]),
               item.depth},
              levels, pending);
    return place;
  }

  // `child.depth` is still its parent's.
  void add_child(NodePlace parent, std::size_t side, Item child, std::uint32_t levels,
                 std::vector<Pending>& pending) {
    const BuildNode& build = tree_.nodes[child.source];
    if (build.is_leaf()) {
      sink_.set_leaf(parent, side, order_ == FaceOrder::kTree ? child.leaves_before : build.face());
      return;
    }
    ++child.depth;
    if (levels > 1) {
      sink_.set_subtree(parent, side, add_subtree(child, levels - 1, pending));
    } else {
      pending.push_back({child, parent, side});
    }
  }

  struct Shrink {
    bool worth = false;
    std::size_t side = 0;  // 0: cut from the high side, the child is a left child
    Cuts<S> cuts;
    Box<S> box;  // what is left
  };

  // The thickest of the six empty slabs between a decoded box and what it must hold, if it is worth
  // a shrink node. Its share of the box's volume is its share of the extent. Guards: the decoded
  // box must really get smaller (rounding may swallow a cut), and the path must stay within the
  // depth of the format.
  Shrink find_shrink(const Item& item, const Box<S>& content) const {
    Shrink best;
    if (item.depth + 1 + tree_.nodes[item.source].height() > kMaxDepth) return best;
    double share = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double extent = double{item.box.high[k]} - double{item.box.low[k]};
      if (!(extent > 0)) continue;
      const double high = (double{item.box.high[k]} - double{content.high[k]}) / extent;
      const double low = (double{content.low[k]} - double{item.box.low[k]}) / extent;
      if (high > share) {
        share = high;
        best.side = 0;
        best.cuts.axis = k;
      }
      if (low > share) {
        share = low;
        best.side = 1;
        best.cuts.axis = k;
      }
    }
    if (share < kShrinkShare) return best;
    const std::size_t axis = best.cuts.axis;
    const S cut =
        Sink::storable(best.side == 0 ? largest_cut_down(item.box.high[axis], content.high[axis])
                                      : largest_cut_up(item.box.low[axis], content.low[axis]));
    best.cuts.cut[best.side] = cut;
    best.box = child_box(item.box, axis, best.side, cut);
    best.worth = best.box != item.box;
    return best;
  }

  [[nodiscard]] NodeKind kind_of(std::uint32_t left, std::uint32_t right) const {
    const bool left_leaf = tree_.nodes[left].is_leaf();
    if (tree_.nodes[right].is_leaf()) {
      return left_leaf ? NodeKind::kTwoLeaves : NodeKind::kRightLeaf;
    }
    return left_leaf ? NodeKind::kLeftLeaf : NodeKind::kNoLeaves;
  }

  const BuildTree& tree_;
  FaceOrder order_;
  Bounds bounds_;
  Sink& sink_;
  VisitCost cost_;
  std::uint32_t node_count_ = 0;
  std::uint32_t shrink_count_ = 0;
  std::uint32_t depth_ = 0;
};

/// The bounds that the build tree holds: f32, rounded outward.
struct BuildBounds {
  const BuildTree* tree;
  const Box<float>& operator()(std::uint32_t node) const { return tree->nodes[node].bounds; }
};

}  // namespace boxtree::cooker
