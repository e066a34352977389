// SPDX-License-Identifier: MIT
// Encoder of plain-f32 and plain-f16 (decoder: format/codec_plain.h).
#include <cstring>
#include <utility>

#include <boxtree/cooker/encode/binary_encoder.h>
#include <boxtree/cooker/encode/encoders.h>
#include <boxtree/format/codec_plain.h>

namespace boxtree::cooker {
namespace {

// A smaller cut moves a plane less, so rounding toward zero stays on the safe side.
void store_cut(float cut, float& out) {
  out = cut;
}
void store_cut(float cut, std::uint16_t& out) {
  out = half_toward_zero(cut);
}

template <class Cut>
class PlainSink {
 public:
  using Scalar = float;
  using Node = PlainNode<Cut>;

  // A little more than the two nodes a face that trees with many shrink nodes have; pages that are
  // not used never become resident.
  explicit PlainSink(std::size_t faces) { bytes_.reserve(faces * 9 / 4 * sizeof(Node)); }

  static float storable(float cut) {
    Cut stored{};
    store_cut(cut, stored);
    return cut_value(stored);
  }

  NodePlace add(NodeKind kind, const Cuts<float>& cuts) {
    Node node{};
    node.cutplane = static_cast<std::uint32_t>(cuts.axis);
    node.child[0] = node.child[1] = kPlainNoChild;
    for (std::size_t side = 0; side < 2; ++side) store_cut(cuts.cut[side], node.cut[side]);
    const std::size_t end = bytes_.size();
    bytes_.resize(end + sizeof(Node));
    std::memcpy(bytes_.data() + end, &node, sizeof(Node));
    return {kind, static_cast<std::uint32_t>(end / sizeof(Node))};
  }
  void set_leaf(NodePlace parent, std::size_t side, std::uint32_t face) {
    set_child(parent, side, PlainChild::kLeaf, face);
  }
  void set_subtree(NodePlace parent, std::size_t side, NodePlace child) {
    set_child(parent, side, PlainChild::kSubtree, child.number);
  }

  [[nodiscard]] std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  void set_child(NodePlace parent, std::size_t side, PlainChild kind, std::uint32_t number) {
    std::byte* const place = bytes_.data() + std::size_t{parent.number} * sizeof(Node);
    auto node = load<Node>(place);
    node.child[side] = number;
    node.cutplane |= static_cast<std::uint32_t>(kind) << (2 + 2 * side);
    std::memcpy(place, &node, sizeof(Node));
  }

  std::vector<std::byte> bytes_;
};

template <class Cut>
EncodedNodes encode(const BuildTree& tree, FaceOrder order) {
  PlainSink<Cut> sink((tree.nodes.size() + 1) / 2);
  EncodedNodes nodes = BinaryEncoder(tree, order, BuildBounds{&tree}, sink).run();
  nodes.bytes = sink.take();
  return nodes;
}

}  // namespace

EncodedNodes encode_plain_f32(const BuildTree& tree, FaceOrder order) {
  return encode<float>(tree, order);
}

EncodedNodes encode_plain_f16(const BuildTree& tree, FaceOrder order) {
  return encode<std::uint16_t>(tree, order);
}

}  // namespace boxtree::cooker
