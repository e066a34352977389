// SPDX-License-Identifier: MIT
// Encoders of packed-f32, packed-f16, packed-f64 and dedup (decoder: format/codec_packed.h).
#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <utility>

#include <boxtree/cooker/encode/binary_encoder.h>
#include <boxtree/cooker/encode/encoders.h>
#include <boxtree/format/codec_packed.h>

namespace boxtree::cooker {
namespace {

std::uint8_t width_of(std::uint64_t largest) {
  return static_cast<std::uint8_t>(std::max(1, static_cast<int>(std::bit_width(largest))));
}

template <PackedCut K>
using CutScalar = std::conditional_t<K == PackedCut::kF64, double, float>;

template <PackedCut K>
CutScalar<K> storable_cut(CutScalar<K> cut) {
  if constexpr (K == PackedCut::kF16) return half_to_float(half_toward_zero(cut));
  return cut;
}

// First pass: counts nodes of each kind, and gathers cuts for the table. Kinds of children and
// cuts do not depend on widths, so both passes see the same tree.
template <PackedCut K>
class CountingSink {
 public:
  using Scalar = CutScalar<K>;

  static Scalar storable(Scalar cut) { return storable_cut<K>(cut); }

  NodePlace add(NodeKind kind, const Cuts<Scalar>& cuts) {
    if constexpr (K == PackedCut::kTable) {
      cuts_.insert(cuts_.end(), {cuts.cut[0], cuts.cut[1]});
    }
    const NodePlace place{kind, counts_[static_cast<std::size_t>(kind)]++};
    if (total_++ == 0) root_ = place;
    return place;
  }
  void set_leaf(NodePlace, std::size_t, std::uint32_t) {}
  void set_subtree(NodePlace, std::size_t, NodePlace) {}

  [[nodiscard]] const std::array<std::uint32_t, kNodeKinds>& counts() const { return counts_; }
  [[nodiscard]] NodePlace root() const { return root_; }

  // Ascending and each once. A cut is never negative, and -0 cannot arise from a difference.
  [[nodiscard]] std::vector<float> unique_cuts() {
    std::sort(cuts_.begin(), cuts_.end());
    cuts_.erase(std::unique(cuts_.begin(), cuts_.end()), cuts_.end());
    return std::move(cuts_);
  }

 private:
  std::array<std::uint32_t, kNodeKinds> counts_{};
  std::uint64_t total_ = 0;
  NodePlace root_{};
  std::vector<float> cuts_;
};

// Second pass: writes fields at the places that the counts of the first one give.
template <PackedCut K>
class PackedSink {
 public:
  using Scalar = CutScalar<K>;

  PackedSink(const PackedHeader& header, std::vector<float> table)
      : table_(std::move(table)), cut_bits_(header.cut_bits) {
    const PackedPlaces places(header);
    bytes_.resize(places.section_bytes);
    std::memcpy(bytes_.data(), &header, sizeof(header));
    if (!table_.empty()) {
      std::memcpy(bytes_.data() + sizeof(header), table_.data(), table_.size() * sizeof(float));
    }
    for (std::size_t kind = 0; kind < kNodeKinds; ++kind) {
      layout_[kind] = PackedLayout(static_cast<NodeKind>(kind), header);
      array_[kind] = bytes_.data() + places.array_at[kind];
    }
  }

  static Scalar storable(Scalar cut) { return storable_cut<K>(cut); }

  NodePlace add(NodeKind kind, const Cuts<Scalar>& cuts) {
    const NodePlace place{kind, count_[static_cast<std::size_t>(kind)]++};
    const PackedLayout& layout = layout_of(place);
    write(place, 0, 2, cuts.axis);
    for (std::size_t side = 0; side < 2; ++side) {
      write(place, layout.cut_at[side], cut_bits_, cut_field(cuts.cut[side]));
      // All bits set until a child is set: what a missing one has.
      write(place, layout.number_at[side], layout.number_bits[side],
            low_bits(layout.number_bits[side]));
    }
    return place;
  }
  void set_leaf(NodePlace parent, std::size_t side, std::uint32_t face) {
    set_number(parent, side, face);
  }
  void set_subtree(NodePlace parent, std::size_t side, NodePlace child) {
    set_number(parent, side, child.number);
    write(parent, layout_of(parent).kind_at[side], 2, static_cast<std::uint64_t>(child.kind));
  }

  [[nodiscard]] std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  [[nodiscard]] const PackedLayout& layout_of(NodePlace place) const {
    return layout_[static_cast<std::size_t>(place.kind)];
  }
  void write(NodePlace place, std::uint32_t at, std::uint32_t width, std::uint64_t value) {
    write_bits(array_[static_cast<std::size_t>(place.kind)],
               std::uint64_t{place.number} * layout_of(place).bits + at, width, value);
  }
  void set_number(NodePlace place, std::size_t side, std::uint32_t number) {
    const PackedLayout& layout = layout_of(place);
    const std::uint8_t width = layout.number_bits[side];
    clear_bits(array_[static_cast<std::size_t>(place.kind)],
               std::uint64_t{place.number} * layout.bits + layout.number_at[side], width);
    write(place, layout.number_at[side], width, number);
  }
  [[nodiscard]] std::uint64_t cut_field(Scalar cut) const {
    if constexpr (K == PackedCut::kF16) return half_toward_zero(cut);
    if constexpr (K == PackedCut::kF64) return std::bit_cast<std::uint64_t>(cut);
    if constexpr (K == PackedCut::kTable) {
      if (!table_.empty()) {
        const auto place = std::lower_bound(table_.begin(), table_.end(), cut);
        return static_cast<std::uint64_t>(place - table_.begin());
      }
    }
    return std::bit_cast<std::uint32_t>(static_cast<float>(cut));
  }

  std::vector<std::byte> bytes_;
  std::vector<float> table_;
  std::array<PackedLayout, kNodeKinds> layout_;
  std::array<std::byte*, kNodeKinds> array_{};
  std::array<std::uint32_t, kNodeKinds> count_{};
  std::uint8_t cut_bits_;
};

// The paper's estimate before a tree exists: three nodes a face. It holds for every mesh seen, and
// where it would not (or would overflow), the exact width is taken.
constexpr std::uint64_t kEstimatedNodesPerFace = 3;

std::uint8_t number_width(std::uint64_t exact_largest, std::uint64_t estimated_largest,
                          FieldWidths widths) {
  const std::uint8_t exact = width_of(exact_largest);
  if (widths == FieldWidths::kExact) return exact;
  const std::uint8_t estimated = width_of(estimated_largest);
  return estimated >= exact && estimated <= 32 ? estimated : exact;
}

PackedHeader header_of(const std::array<std::uint32_t, kNodeKinds>& counts, std::uint64_t faces,
                       FieldWidths widths) {
  PackedHeader header{};
  header.node_count = counts;
  // The largest number is one below the largest count, so that count itself fits: all bits set is
  // never a node and can mark a missing child.
  const std::uint64_t most = *std::max_element(counts.begin(), counts.end());
  header.node_bits = number_width(most, kEstimatedNodesPerFace * faces, widths);
  header.face_bits = width_of(faces - 1);
  return header;
}

// The paper's rule between table and nodes: whichever is smaller (section 4.3).
void choose_table(PackedHeader& header, std::vector<float>& table, std::uint64_t faces,
                  FieldWidths widths) {
  header.cut_bits = 32;
  const std::uint64_t in_nodes = PackedPlaces(header).section_bytes;
  PackedHeader with_table = header;
  with_table.cut_count = static_cast<std::uint32_t>(table.size());
  with_table.cut_bits = number_width(table.size() - 1, 2 * kEstimatedNodesPerFace * faces, widths);
  if (PackedPlaces(with_table).section_bytes < in_nodes) {
    header = with_table;
  } else {
    table.clear();
  }
}

template <PackedCut K, class Bounds>
EncodedNodes encode(const BuildTree& tree, FaceOrder order, Bounds bounds, FieldWidths widths) {
  CountingSink<K> counting;
  EncodedNodes nodes = BinaryEncoder(tree, order, bounds, counting).run();
  if (nodes.root != RootKind::kSubtree) return nodes;
  const std::uint64_t faces = (tree.nodes.size() + 1) / 2;
  PackedHeader header = header_of(counting.counts(), faces, widths);
  std::vector<float> table;
  if constexpr (K == PackedCut::kTable) {
    table = counting.unique_cuts();
    nodes.unique_cuts = table.size();
    choose_table(header, table, faces, widths);
  } else {
    header.cut_bits = K == PackedCut::kF16 ? 16 : K == PackedCut::kF32 ? 32 : 64;
  }
  // The root is the first node of its kind.
  header.root_kind = static_cast<std::uint8_t>(counting.root().kind);
  PackedSink<K> sink(header, std::move(table));
  static_cast<void>(BinaryEncoder(tree, order, bounds, sink).run());
  nodes.bytes = sink.take();
  nodes.kind_count = counting.counts();
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

EncodedNodes encode_packed_f32(const BuildTree& tree, FaceOrder order, FieldWidths widths) {
  return encode<PackedCut::kF32>(tree, order, BuildBounds{&tree}, widths);
}

EncodedNodes encode_packed_f16(const BuildTree& tree, FaceOrder order, FieldWidths widths) {
  return encode<PackedCut::kF16>(tree, order, BuildBounds{&tree}, widths);
}

EncodedNodes encode_dedup(const BuildTree& tree, FaceOrder order, FieldWidths widths) {
  return encode<PackedCut::kTable>(tree, order, BuildBounds{&tree}, widths);
}

EncodedNodes encode_packed_f64(const BuildTree& tree, const SourceMesh& mesh, FaceOrder order,
                               FieldWidths widths) {
  const std::vector<Box<double>> bounds = bounds_in_double(tree, mesh);
  const auto at = [&bounds](std::uint32_t node) -> const Box<double>& { return bounds[node]; };
  return encode<PackedCut::kF64>(tree, order, at, widths);
}

}  // namespace boxtree::cooker
