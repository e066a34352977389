// SPDX-License-Identifier: MIT
// Encoder of wide8 and wide4 (decoder: format/codec_wide.h).
#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "cooker/encode/encoders.h"
#include "cooker/encode/visit_cost.h"

namespace boxtree::cooker {
namespace {

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

// A code large enough for a plane at `distance` from its side; rounding is less than a step.
template <class Node>
std::uint32_t first_guess(float distance, float step) {
  if (!(step > 0)) return Node::kLargestCode;  // all codes give the same plane
  const float steps = distance / step + 2;
  if (!(steps < Node::kStepsOfExtent)) return Node::kLargestCode;
  return std::min(Node::kLargestCode, Node::code_above(steps));
}

// The largest code whose plane, as the reader computes it, does not pass `bound`; code 0 never
// does. The plane must not pass it with a fused multiply-add either.
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

template <class Node>
class WideEncoder {
 public:
  explicit WideEncoder(const WideLayout& layout)
      : layout_(layout), bytes_(layout.nodes.size() * sizeof(Node)), cost_(layout.root_box) {}

  EncodedNodes run() {
    EncodedNodes out;
    out.root = layout_.root;
    for (std::size_t k = 0; k < 3; ++k) {
      out.root_box.low[k] = layout_.root_box.low[k];
      out.root_box.high[k] = layout_.root_box.high[k];
    }
    out.node_count = static_cast<std::uint32_t>(layout_.nodes.size());
    out.leaf_count = layout_.leaf_count;
    out.depth = layout_.depth;
    if (out.root != RootKind::kSubtree) return out;
    encode(0, layout_.root_box);
    out.bytes = std::move(bytes_);
    out.visits = cost_.visits();
    return out;
  }

 private:
  // Writes node `number`, whose decoded box is `box`, and its subtree.
  void encode(std::uint32_t number, const Box<float>& box) {
    cost_.add(box);
    const WideLayout::Node& from = layout_.nodes[number];
    Node node{};
    set_links(node, from.links);
    std::array<Box<float>, kWideChildren> decoded;
    for (std::size_t i = 0; i < from.links.child_count; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const float step = wide_step<Node>(box.low[k], box.high[k]);
        const std::uint32_t low = low_code<Node>(box.low[k], step, from.content[i].low[k]);
        const std::uint32_t high = high_code<Node>(box.high[k], step, from.content[i].high[k]);
        set_codes(node, k, i, low, high);
        decoded[i].low[k] = wide_low_plane<Node>(box.low[k], step, low);
        decoded[i].high[k] = wide_high_plane<Node>(box.high[k], step, high);
      }
    }
    std::memcpy(bytes_.data() + std::size_t{number} * sizeof(Node), &node, sizeof(Node));
    std::uint32_t next_node = from.links.first_node;
    for (std::size_t i = 0; i < from.links.child_count; ++i) {
      if ((from.links.inner_mask >> i & 1u) != 0) encode(next_node++, decoded[i]);
    }
  }

  const WideLayout& layout_;
  std::vector<std::byte> bytes_;
  VisitCost cost_;
};

}  // namespace

EncodedNodes encode_wide(const WideLayout& layout, CodecId codec) {
  static_assert(std::count_if(kCodecs.begin(), kCodecs.end(),
                              [](const CodecInfo& info) { return is_wide(info.id); }) == 2);
  EncodedNodes nodes = codec == CodecId::kWide8 ? WideEncoder<Wide8Node>(layout).run()
                                                : WideEncoder<Wide4Node>(layout).run();
  nodes.codec = codec;
  return nodes;
}

}  // namespace boxtree::cooker
