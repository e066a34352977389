// SPDX-License-Identifier: MIT
// Encoder of plain-f32 and plain-f16 (decoder: format/codec_plain.h). Walks the build tree with the
// decoded box that a reader will see and cuts only as far as that box allows.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include <boxtree/cooker/encode/encoded.h>
#include <boxtree/cooker/encode/visit_cost.h>
#include <boxtree/format/codec_plain.h>
#include <boxtree/format/limits.h>

namespace boxtree::cooker {
namespace {

// The paper's threshold: an empty slab is cut off when it holds at least this share of the box.
constexpr double kShrinkShare = 0.15;

// The largest f32 cut for which the reader's plane, fl(plane - cut), is not below `bound`. The
// first guess is off by rounding only; cut 0 always satisfies, so the loop ends.
float largest_cut_down(float plane, float bound) {
  float cut = plane - bound;
  while (plane - cut < bound) cut = std::nextafter(cut, 0.0f);
  return cut;
}

// The same for a plane that moves up: fl(plane + cut) is not above `bound`.
float largest_cut_up(float plane, float bound) {
  float cut = bound - plane;
  while (plane + cut > bound) cut = std::nextafter(cut, 0.0f);
  return cut;
}

// A smaller cut moves a plane less, so rounding toward zero stays on the safe side.
void store_cut(float cut, float& out) {
  out = cut;
}
void store_cut(float cut, std::uint16_t& out) {
  out = half_toward_zero(cut);
}

template <class Cut>
class PlainEncoder {
 public:
  PlainEncoder(const BuildTree& tree, FaceOrder order) : tree_(tree), order_(order) {}

  EncodedNodes run() {
    EncodedNodes out;
    if (tree_.nodes.empty()) return out;
    const Box<float>& root = tree_.nodes[0].bounds;
    for (std::size_t k = 0; k < 3; ++k) {
      out.root_box.low[k] = root.low[k];
      out.root_box.high[k] = root.high[k];
    }
    cost_ = VisitCost(root);
    if (tree_.nodes[0].is_leaf()) {
      out.root = RootKind::kLeaf;
      leaf_count_ = 1;
    } else {
      out.root = RootKind::kSubtree;
      // A little more than the two nodes a face that trees with many shrink nodes have; pages that
      // are not used never become resident.
      bytes_.reserve((tree_.nodes.size() + 1) / 2 * 9 / 4 * sizeof(Node));
      add_subtree(0, root, 0);
    }
    out.node_count = node_count();
    out.bytes = std::move(bytes_);
    out.leaf_count = leaf_count_;
    out.shrink_count = shrink_count_;
    out.depth = depth_;
    out.visits = cost_.visits();
    return out;
  }

 private:
  using Node = PlainNode<Cut>;

  // Appends the nodes of a build subtree, whose box a reader decodes as `box`. The recursion is as
  // deep as the tree, which kMaxDepth bounds.
  void add_subtree(std::uint32_t source, const Box<float>& box, std::uint32_t depth) {
    cost_.add(box);
    depth_ = std::max(depth_, depth + 1);
    if (add_shrink(source, box, depth)) return;

    const BuildNode& build = tree_.nodes[source];
    const std::uint32_t axis = build.axis();
    const std::uint32_t left = source + 1;
    const std::uint32_t right = build.right;
    const std::uint32_t place = append({});  // filled when the children's places are known
    Node node{};
    store_cut(largest_cut_down(box.high[axis], tree_.nodes[left].bounds.high[axis]), node.cut[0]);
    store_cut(largest_cut_up(box.low[axis], tree_.nodes[right].bounds.low[axis]), node.cut[1]);
    node.cutplane = plain_cutplane(axis, kind_of(left), kind_of(right));
    node.child[0] = add_child(left, below_cut(box, node, 0), depth);
    node.child[1] = add_child(right, below_cut(box, node, 1), depth);
    std::memcpy(bytes_.data() + std::size_t{place} * sizeof(Node), &node, sizeof(Node));
  }

  [[nodiscard]] std::uint32_t node_count() const {
    return static_cast<std::uint32_t>(bytes_.size() / sizeof(Node));
  }

  // Returns the number of the new node.
  std::uint32_t append(const Node& node) {
    const std::uint32_t place = node_count();
    bytes_.resize(bytes_.size() + sizeof(Node));
    std::memcpy(bytes_.data() + std::size_t{place} * sizeof(Node), &node, sizeof(Node));
    return place;
  }

  std::uint32_t add_child(std::uint32_t source, const Box<float>& box, std::uint32_t depth) {
    const BuildNode& build = tree_.nodes[source];
    if (build.is_leaf()) {
      const std::uint32_t position = leaf_count_++;
      return order_ == FaceOrder::kTree ? position : build.face();
    }
    const std::uint32_t place = node_count();
    add_subtree(source, box, depth + 1);
    return place;
  }

  struct Slab {
    std::uint32_t axis = 0;
    int side = 0;  // 0: cut from the high side, the child is a left child
    double share = 0;
  };

  // The thickest of the six empty slabs between a decoded box and what it must hold, as a share of
  // the box: of its volume, which for a slab is the same as of its extent.
  static Slab largest_empty_slab(const Box<float>& box, const Box<float>& content) {
    Slab best;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const double extent = double{box.high[k]} - box.low[k];
      if (!(extent > 0)) continue;
      const double high_share = (double{box.high[k]} - content.high[k]) / extent;
      const double low_share = (double{content.low[k]} - box.low[k]) / extent;
      if (high_share > best.share) best = {k, 0, high_share};
      if (low_share > best.share) best = {k, 1, low_share};
    }
    return best;
  }

  // Puts a shrink node above the subtree if a slab is worth it. Guards: the decoded box must really
  // get smaller (rounding may swallow a cut), and the path must stay within the format's depth.
  bool add_shrink(std::uint32_t source, const Box<float>& box, std::uint32_t depth) {
    const BuildNode& build = tree_.nodes[source];
    if (depth + 1 + build.height() > kMaxDepth) return false;
    const Slab slab = largest_empty_slab(box, build.bounds);
    if (slab.share < kShrinkShare) return false;

    Node node{};
    const std::uint32_t axis = slab.axis;
    store_cut(slab.side == 0 ? largest_cut_down(box.high[axis], build.bounds.high[axis])
                             : largest_cut_up(box.low[axis], build.bounds.low[axis]),
              node.cut[slab.side]);
    node.cutplane = slab.side == 0 ? plain_cutplane(axis, PlainChild::kSubtree, PlainChild::kNone)
                                   : plain_cutplane(axis, PlainChild::kNone, PlainChild::kSubtree);
    const Box<float> child = below_cut(box, node, slab.side);
    if (child == box) return false;

    node.child[slab.side] = node_count() + 1;
    node.child[1 - slab.side] = kPlainNoChild;
    append(node);
    ++shrink_count_;
    add_subtree(source, child, depth + 1);
    return true;
  }

  // The child's box by the reader's own arithmetic.
  static Box<float> below_cut(const Box<float>& box, const Node& node, int side) {
    Box<float> child = box;
    const std::uint32_t axis = node.axis();
    const float cut = plain_cut_value(node.cut[side]);
    if (side == 0) {
      child.high[axis] = box.high[axis] - cut;
    } else {
      child.low[axis] = box.low[axis] + cut;
    }
    return child;
  }

  [[nodiscard]] PlainChild kind_of(std::uint32_t source) const {
    return tree_.nodes[source].is_leaf() ? PlainChild::kLeaf : PlainChild::kSubtree;
  }

  const BuildTree& tree_;
  FaceOrder order_;
  std::vector<std::byte> bytes_;
  VisitCost cost_;
  std::uint32_t leaf_count_ = 0;
  std::uint32_t shrink_count_ = 0;
  std::uint32_t depth_ = 0;
};

}  // namespace

EncodedNodes encode_nodes(const BuildTree& tree, CodecId codec, FaceOrder order) {
  EncodedNodes nodes = codec == CodecId::kPlainF16 ? PlainEncoder<std::uint16_t>(tree, order).run()
                                                   : PlainEncoder<float>(tree, order).run();
  nodes.codec = codec;
  return nodes;
}

}  // namespace boxtree::cooker
