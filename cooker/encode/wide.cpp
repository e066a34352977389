// SPDX-License-Identifier: MIT
// Encoder of wide8 and wide4 (decoder: format/codec_wide.h).
#include <cmath>
#include <cstring>
#include <utility>

#include <boxtree/cooker/encode/encoders.h>
#include <boxtree/cooker/encode/visit_cost.h>
#include <boxtree/cooker/encode/wide_collapse.h>

namespace boxtree::cooker {
namespace {

// What a node's bytes weigh against visits to it, in areas of the root.
constexpr double kNodeCost = 1e-4;

void set_codes(Wide8Node& node, std::size_t axis, std::size_t child, std::uint32_t low,
               std::uint32_t high) {
  node.low[axis][child] = static_cast<std::uint8_t>(low);
  node.high[axis][child] = static_cast<std::uint8_t>(high);
}
void set_codes(Wide4Node& node, std::size_t axis, std::size_t child, std::uint32_t low,
               std::uint32_t high) {
  node.low[axis] |= low << (4 * child);
  node.high[axis] |= high << (4 * child);
}

void set_links(Wide8Node& node, const WideLinks& links) {
  node.first_node = links.first_node;
  node.first_leaf = links.first_leaf;
  node.inner_mask = static_cast<std::uint8_t>(links.inner_mask);
  node.child_count = static_cast<std::uint8_t>(links.child_count);
}
void set_links(Wide4Node& node, const WideLinks& links) {
  node.links = std::uint64_t{links.first_node} | std::uint64_t{links.first_leaf} << 26 |
               std::uint64_t{links.inner_mask} << 53 | std::uint64_t{links.child_count - 1} << 61;
}

// A code that is large enough for a plane `distance` from its side: rounding is less than a step.
template <class Node>
std::uint32_t first_guess(float distance, float step) {
  if (!(step > 0)) return Node::kLargestCode;  // all codes give the same plane
  const float steps = distance / step + 2;
  if (!(steps < Node::kStepsOfExtent)) return Node::kLargestCode;
  return std::min(Node::kLargestCode, Node::code_above(steps));
}

// The largest code whose plane, as the reader computes it, does not pass `bound`; 0 never does. A
// reader that fuses the product into the sum must not pass it either.
template <class Node>
std::uint32_t low_code(float low, float step, float bound) {
  std::uint32_t code = first_guess<Node>(bound - low, step);
  while (code > 0 && (wide_low_plane<Node>(low, step, code) > bound ||
                      std::fma(Node::steps(code), step, low) > bound)) {
    --code;
  }
  return code;
}
template <class Node>
std::uint32_t high_code(float high, float step, float bound) {
  std::uint32_t code = first_guess<Node>(high - bound, step);
  while (code > 0 && (wide_high_plane<Node>(high, step, code) < bound ||
                      std::fma(-Node::steps(code), step, high) < bound)) {
    --code;
  }
  return code;
}

EncodedNodes empty_nodes(const BuildTree& tree, RootKind root) {
  EncodedNodes out;
  out.root = root;
  for (std::size_t k = 0; k < 3; ++k) {
    out.root_box.low[k] = tree.nodes[0].bounds.low[k];
    out.root_box.high[k] = tree.nodes[0].bounds.high[k];
  }
  return out;
}

template <class Node>
class WideEncoder {
 public:
  explicit WideEncoder(const BuildTree& tree) : tree_(tree), collapse_(tree, kNodeCost) {
    leaf_count_ = static_cast<std::uint32_t>(leaves_of(tree.order.size()));
    has_partial_leaf_ = tree.order.size() % kLeafFaces != 0;
    face_order_.resize(tree.order.size());
  }

  EncodedNodes run() {
    const Box<float>& root = tree_.nodes[0].bounds;
    cost_ = VisitCost(root);
    bytes_.resize(sizeof(Node));
    node_count_ = 1;
    encode(0, 0, root, 1);
    EncodedNodes out = empty_nodes(tree_, RootKind::kSubtree);
    out.bytes = std::move(bytes_);
    out.node_count = node_count_;
    out.leaf_count = leaf_count_;
    out.depth = depth_;
    out.visits = cost_.visits();
    out.face_order = std::move(face_order_);
    return out;
  }

 private:
  // Writes node `number` for the node `source` of the build tree, and all below it. Nodes that are
  // siblings stand together, then what is below the first of them, and so on.
  void encode(std::uint32_t number, std::uint32_t source, const Box<float>& box,
              std::uint32_t depth) {
    cost_.add(box);
    depth_ = std::max(depth_, depth);
    std::vector<std::uint32_t> children;
    collapse_.children_of(source, children);

    WideLinks links{node_count_, next_leaf_, 0, static_cast<std::uint32_t>(children.size())};
    std::uint32_t leaves = 0;
    bool holds_partial_leaf = false;
    for (std::size_t i = 0; i < children.size(); ++i) {
      if (!tree_.nodes[children[i]].is_leaf()) {
        links.inner_mask |= 1u << i;
        ++node_count_;
        continue;
      }
      ++leaves;
      holds_partial_leaf |= is_partial(children[i]);
    }
    // The leaf that is not full must have the last number of all. It is the last one from left to
    // right, so the last one among these, too.
    if (holds_partial_leaf) {
      links.first_leaf = leaf_count_ - leaves;
    } else {
      next_leaf_ += leaves;
    }
    bytes_.resize(std::size_t{node_count_} * sizeof(Node));
    write(number, children, links, box, depth);
  }

  void write(std::uint32_t number, const std::vector<std::uint32_t>& children,
             const WideLinks& links, const Box<float>& box, std::uint32_t depth) {
    Node node{};
    set_links(node, links);
    std::array<Box<float>, kWideChildren> decoded;
    for (std::size_t i = 0; i < children.size(); ++i) {
      const Box<float>& content = tree_.nodes[children[i]].bounds;
      for (std::size_t k = 0; k < 3; ++k) {
        const float step = wide_step<Node>(box.low[k], box.high[k]);
        const std::uint32_t low = low_code<Node>(box.low[k], step, content.low[k]);
        const std::uint32_t high = high_code<Node>(box.high[k], step, content.high[k]);
        set_codes(node, k, i, low, high);
        decoded[i].low[k] = wide_low_plane<Node>(box.low[k], step, low);
        decoded[i].high[k] = wide_high_plane<Node>(box.high[k], step, high);
      }
    }
    std::memcpy(bytes_.data() + std::size_t{number} * sizeof(Node), &node, sizeof(Node));
    std::uint32_t next_node = links.first_node;
    std::uint32_t next_leaf = links.first_leaf;
    for (std::size_t i = 0; i < children.size(); ++i) {
      if (tree_.nodes[children[i]].is_leaf()) {
        place_leaf(next_leaf++, children[i]);
      } else {
        encode(next_node++, children[i], decoded[i], depth + 1);
      }
    }
  }

  [[nodiscard]] bool is_partial(std::uint32_t leaf) const {
    return has_partial_leaf_ && tree_.nodes[leaf].first() + kLeafFaces > tree_.order.size();
  }

  // The faces of a leaf take the places that its number says.
  void place_leaf(std::uint32_t number, std::uint32_t leaf) {
    const std::size_t from = tree_.nodes[leaf].first();
    const std::size_t to = std::size_t{number} * kLeafFaces;
    for (std::size_t i = 0; i < kLeafFaces && from + i < tree_.order.size(); ++i) {
      face_order_[to + i] = tree_.order[from + i];
    }
  }

  const BuildTree& tree_;
  WideCollapse collapse_;
  VisitCost cost_;
  std::vector<std::byte> bytes_;
  std::vector<std::uint32_t> face_order_;
  std::uint32_t leaf_count_ = 0;
  bool has_partial_leaf_ = false;
  std::uint32_t node_count_ = 0;
  std::uint32_t next_leaf_ = 0;
  std::uint32_t depth_ = 0;
};

template <class Node>
EncodedNodes encode(const BuildTree& tree) {
  if (tree.nodes.size() > 1) return WideEncoder<Node>(tree).run();
  if (tree.nodes.empty()) return {};
  EncodedNodes out = empty_nodes(tree, RootKind::kLeaf);
  out.leaf_count = 1;
  out.face_order = tree.order;
  return out;
}

}  // namespace

EncodedNodes encode_wide(const BuildTree& full_leaves, CodecId codec) {
  EncodedNodes nodes =
      codec == CodecId::kWide8 ? encode<Wide8Node>(full_leaves) : encode<Wide4Node>(full_leaves);
  nodes.codec = codec;
  return nodes;
}

}  // namespace boxtree::cooker
