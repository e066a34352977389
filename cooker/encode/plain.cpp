// SPDX-License-Identifier: MIT
// Encoder of plain-f32, plain-f16 (decoder: format/codec_plain.h) and of the plain nodes that the
// packed codecs start from. The walk from the build tree to nodes carries the box that a reader
// decodes and cuts only as far as that box allows.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "cooker/encode/encoders.h"
#include "cooker/encode/visit_cost.h"
#include "format/codec_plain.h"
#include "format/limits.h"

namespace boxtree::cooker {
namespace {

// Number of levels stored together before the subtrees below them, so that a descent reads few
// pages: 2^8 nodes of 16 bytes are a page of 4096.
constexpr std::uint32_t kClusterLevels = 8;

// The largest cut for which the reader's plane, fl(plane - cut), is not below `bound`. The first
// guess is off only by rounding; cut 0 always satisfies, so the loop ends. The result is never -0,
// which would be a second encoding of 0.
template <class S>
S largest_cut_down(S plane, S bound) {
  S cut = plane - bound;
  while (plane - cut < bound) cut = std::nextafter(cut, S{0});
  return cut + S{0};
}

// The same for a plane that moves up: fl(plane + cut) is not above `bound`.
template <class S>
S largest_cut_up(S plane, S bound) {
  S cut = bound - plane;
  while (plane + cut > bound) cut = std::nextafter(cut, S{0});
  return cut + S{0};
}

// A smaller cut moves a plane less, so rounding toward zero is conservative.
void store_cut(float cut, float& out) {
  out = cut;
}
void store_cut(double cut, double& out) {
  out = cut;
}
void store_cut(float cut, std::uint16_t& out) {
  out = half_toward_zero(cut);
}

// Bounds: a callable, node of the build tree -> Box<S> of what is below it.
template <class Cut, class Bounds>
class PlainEncoder {
 public:
  using Node = PlainNode<Cut>;
  using S = std::conditional_t<std::is_same_v<Cut, double>, double, float>;  // of the reader

  PlainEncoder(const BuildTree& tree, FaceOrder order, double shrink_share, Bounds bounds)
      : tree_(tree), order_(order), shrink_share_(shrink_share), bounds_(bounds) {}

  // Encodes the whole tree. The root is the first node added.
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
    const std::size_t leaves = (tree_.nodes.size() + 1) / 2;
    out.root = RootKind::kSubtree;
    out.leaf_count = static_cast<std::uint32_t>(leaves);
    // A little more than the two nodes per face of trees with many shrink nodes; unused pages never
    // become resident.
    bytes_.reserve(leaves * 9 / 4 * sizeof(Node));
    cost_ = VisitCost(root);
    add_cluster({0, 0, root, 0});
    out.node_count = static_cast<std::uint32_t>(bytes_.size() / sizeof(Node));
    out.bytes = std::move(bytes_);
    out.shrink_count = shrink_count_;
    out.depth = depth_;
    out.visits = cost_.visits();
    return out;
  }

 private:
  // A subtree to encode: its node in the build tree, the number of leaves before it, the box that a
  // reader decodes for it and the number of nodes above it.
  struct Item {
    std::uint32_t source;
    std::uint32_t leaves_before;
    Box<S> box;
    std::uint32_t depth;
  };
  // A subtree to encode later; its parent needs its number then.
  struct Pending {
    Item item;
    std::uint32_t parent;
    std::size_t side;
  };

  // Adds the top levels of a subtree in preorder, then the subtrees below them, one after another.
  // The recursion is as deep as the tree, which kMaxDepth bounds. Returns the subtree's number.
  std::uint32_t add_cluster(const Item& item) {
    std::vector<Pending> pending;
    const std::uint32_t number = add_subtree(item, kClusterLevels, pending);
    for (const Pending& below : pending) {
      set_child(below.parent, below.side, PlainChild::kSubtree, add_cluster(below.item));
    }
    return number;
  }

  std::uint32_t add_subtree(const Item& item, std::uint32_t levels, std::vector<Pending>& pending) {
    cost_.add(item.box);
    depth_ = std::max(depth_, item.depth + 1);
    const BuildNode& build = tree_.nodes[item.source];
    const Box<S> content = bounds_(item.source);
    if (const Shrink shrink = find_shrink(item, content); shrink.worth) {
      ++shrink_count_;
      std::array<S, 2> cuts{};
      cuts[shrink.side] = shrink.cut;
      const std::uint32_t number = add_node(shrink.axis, cuts);
      add_child(number, shrink.side, {item.source, item.leaves_before, shrink.box, item.depth},
                levels, pending);
      return number;
    }
    const std::uint32_t left = item.source + 1;
    const std::uint32_t right = build.right;
    const std::size_t axis = build.axis();
    const std::array<S, 2> cuts = {cut_down_to(bounds_(left), item.box, axis),
                                   cut_up_to(bounds_(right), item.box, axis)};
    const std::uint32_t number = add_node(axis, cuts);
    // A subtree of n leaves has 2n - 1 nodes, so the place of the right one counts the left leaves.
    const std::uint32_t left_leaves = (right - item.source) / 2;
    add_child(number, 0,
              {left, item.leaves_before, child_box(item.box, axis, 0, cuts[0]), item.depth}, levels,
              pending);
    add_child(number, 1,
              {right, item.leaves_before + left_leaves, child_box(item.box, axis, 1, cuts[1]),
               item.depth},
              levels, pending);
    return number;
  }

  // `child.depth` is still the parent's depth.
  void add_child(std::uint32_t parent, std::size_t side, Item child, std::uint32_t levels,
                 std::vector<Pending>& pending) {
    const BuildNode& build = tree_.nodes[child.source];
    if (build.is_leaf()) {
      set_child(parent, side, PlainChild::kLeaf,
                order_ == FaceOrder::kTree ? child.leaves_before : build.face());
      return;
    }
    ++child.depth;
    if (levels > 1) {
      set_child(parent, side, PlainChild::kSubtree, add_subtree(child, levels - 1, pending));
    } else {
      pending.push_back({child, parent, side});
    }
  }

  struct Shrink {
    bool worth = false;
    std::size_t side = 0;  // 0: cut from the high side, the child is a left child
    std::size_t axis = 0;
    S cut = 0;
    Box<S> box;  // what remains
  };

  // The thickest of the six empty slabs between a decoded box and its content, if it is worth a
  // shrink node. A slab's share of the box's volume is its share of the extent. The decoded box
  // must become smaller (rounding may absorb a cut), and the path must not exceed the format's
  // depth.
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
        best.axis = k;
      }
      if (low > share) {
        share = low;
        best.side = 1;
        best.axis = k;
      }
    }
    if (share < shrink_share_) return best;
    best.cut = best.side == 0 ? cut_down_to(content, item.box, best.axis)
                              : cut_up_to(content, item.box, best.axis);
    best.box = child_box(item.box, best.axis, best.side, best.cut);
    best.worth = best.box != item.box;
    return best;
  }

  // The largest cuts that can be stored and leave `content` in the box.
  static S cut_down_to(const Box<S>& content, const Box<S>& box, std::size_t axis) {
    return storable(largest_cut_down(box.high[axis], content.high[axis]));
  }
  static S cut_up_to(const Box<S>& content, const Box<S>& box, std::size_t axis) {
    return storable(largest_cut_up(box.low[axis], content.low[axis]));
  }
  static S storable(S cut) {
    Cut stored{};
    store_cut(cut, stored);
    return cut_value(stored);
  }

  // Appends a node without children and returns its number. A missing child has cut 0.
  std::uint32_t add_node(std::size_t axis, const std::array<S, 2>& cuts) {
    Node node{};
    node.cutplane = static_cast<std::uint32_t>(axis);
    for (std::size_t side = 0; side < 2; ++side) {
      node.child[side] = kPlainNoChild;
      store_cut(cuts[side], node.cut[side]);
    }
    const std::size_t end = bytes_.size();
    bytes_.resize(end + sizeof(Node));
    std::memcpy(bytes_.data() + end, &node, sizeof(Node));
    return static_cast<std::uint32_t>(end / sizeof(Node));
  }

  void set_child(std::uint32_t parent, std::size_t side, PlainChild kind, std::uint32_t number) {
    std::byte* const place = bytes_.data() + std::size_t{parent} * sizeof(Node);
    auto node = load<Node>(place);
    node.child[side] = number;
    node.cutplane |= static_cast<std::uint32_t>(kind) << (2 + 2 * side);
    std::memcpy(place, &node, sizeof(Node));
  }

  const BuildTree& tree_;
  FaceOrder order_;
  double shrink_share_;
  Bounds bounds_;
  std::vector<std::byte> bytes_;
  VisitCost cost_;
  std::uint32_t shrink_count_ = 0;
  std::uint32_t depth_ = 0;
};

template <class Cut, class Bounds>
EncodedNodes encode(const BuildTree& tree, FaceOrder order, double shrink_share, Bounds bounds) {
  return PlainEncoder<Cut, Bounds>(tree, order, shrink_share, bounds).run();
}

// The box that each node of the build tree must contain, without rounding to f32. Computed from the
// leaves up; children have larger indices than their parents.
std::vector<Box<double>> bounds_in_double(const BuildTree& tree, const MeshView& mesh) {
  const Frame frame = tree.frame();
  std::vector<Box<double>> bounds(tree.nodes.size());
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {
    const BuildNode& node = tree.nodes[i];
    if (node.is_leaf()) {
      bounds[i] = face_bounds(mesh, frame, node.face());
      continue;
    }
    const Box<double>& left = bounds[i + 1];
    const Box<double>& right = bounds[node.right];
    for (std::size_t k = 0; k < 3; ++k) {
      bounds[i].low[k] = std::min(left.low[k], right.low[k]);
      bounds[i].high[k] = std::max(left.high[k], right.high[k]);
    }
  }
  return bounds;
}

}  // namespace

EncodedNodes encode_plain(const BuildTree& tree, const MeshView& mesh, PlainCut cut,
                          FaceOrder order, double shrink_share) {
  if (cut == PlainCut::kF64) {
    const std::vector<Box<double>> bounds = bounds_in_double(tree, mesh);
    const auto at = [&bounds](std::uint32_t node) -> const Box<double>& { return bounds[node]; };
    return encode<double>(tree, order, shrink_share, at);
  }
  // The build tree's own bounds: f32, rounded outward.
  const auto at = [&tree](std::uint32_t node) -> const Box<float>& {
    return tree.nodes[node].bounds;
  };
  const bool is_f16 = cut == PlainCut::kF16;
  EncodedNodes nodes = is_f16 ? encode<std::uint16_t>(tree, order, shrink_share, at)
                              : encode<float>(tree, order, shrink_share, at);
  nodes.codec = is_f16 ? CodecId::kPlainF16 : CodecId::kPlainF32;
  return nodes;
}

}  // namespace boxtree::cooker
