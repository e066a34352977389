// SPDX-License-Identifier: MIT
// Encoder of plain-f32 and plain-f16 (decoder: format/codec_plain.h), and of the plain nodes that
// the packed codecs start from.
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
void store_cut(double cut, double& out) {
  out = cut;
}
void store_cut(float cut, std::uint16_t& out) {
  out = half_toward_zero(cut);
}

template <class Cut>
class PlainSink {
 public:
  using Scalar = std::conditional_t<std::is_same_v<Cut, double>, double, float>;
  using Node = PlainNode<Cut>;

  // A little more than the two nodes a face that trees with many shrink nodes have; pages that are
  // not used never become resident.
  explicit PlainSink(std::size_t faces) { bytes_.reserve(faces * 9 / 4 * sizeof(Node)); }

  static Scalar storable(Scalar cut) {
    Cut stored{};
    store_cut(cut, stored);
    return cut_value(stored);
  }

  NodePlace add(NodeKind kind, const Cuts<Scalar>& cuts) {
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

template <class Cut, class Bounds>
EncodedNodes encode(const BuildTree& tree, FaceOrder order, Bounds bounds) {
  PlainSink<Cut> sink((tree.nodes.size() + 1) / 2);
  EncodedNodes nodes = BinaryEncoder(tree, order, bounds, sink).run();
  nodes.bytes = sink.take();
  return nodes;
}

// What each node of the build tree must hold, without rounding to f32: from the leaves up, which
// stand behind their parents.
std::vector<Box<double>> bounds_in_double(const BuildTree& tree, const SourceMesh& mesh) {
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

EncodedNodes encode_plain(const BuildTree& tree, const SourceMesh& mesh, PlainCut cut,
                          FaceOrder order) {
  if (cut == PlainCut::kF16) return encode<std::uint16_t>(tree, order, BuildBounds{&tree});
  if (cut == PlainCut::kF32) return encode<float>(tree, order, BuildBounds{&tree});
  const std::vector<Box<double>> bounds = bounds_in_double(tree, mesh);
  const auto at = [&bounds](std::uint32_t node) -> const Box<double>& { return bounds[node]; };
  return encode<double>(tree, order, at);
}

}  // namespace boxtree::cooker
