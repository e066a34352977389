// SPDX-License-Identifier: MIT
// Encoder of the geometry stores "exact" and "grid" (decoder: format/cluster.cpp).
#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include "cooker/encode/axis_fields.h"
#include "cooker/encode/encoded.h"
#include "cooker/encode/strip.h"
#include "format/bits.h"
#include "format/cluster_leaf.h"

namespace boxtree::cooker {
namespace {

// The vertices of one cluster without duplicates. Vertices are compared by their numbers, not by
// source numbers, so vertices that are equal on the grid or were never welded are stored once.
template <class Number>
class ClusterVertices {
 public:
  using Point = std::array<Number, 3>;

  ClusterVertices() { slots_.fill(kFree); }

  [[nodiscard]] std::uint16_t number_of(const Point& point) {
    std::size_t slot = hash(point) % kSlots;
    while (slots_[slot] != kFree && points_[slots_[slot]] != point) slot = (slot + 1) % kSlots;
    if (slots_[slot] == kFree) {
      slots_[slot] = count_;
      points_[count_++] = point;
    }
    return slots_[slot];
  }
  [[nodiscard]] std::uint16_t count() const { return count_; }
  [[nodiscard]] const Point& operator[](std::size_t i) const { return points_[i]; }

  // Takes zero bits off the end of all numbers of an axis, as many as all have, and returns how
  // many. The bits of floats, not of their numbers, end with them.
  [[nodiscard]] std::uint8_t take_trailing_zeros(std::size_t axis, bool are_floats) {
    using Bits = std::make_unsigned_t<Number>;
    Bits any = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const Number number = points_[i][axis];
      any |= static_cast<Bits>(are_floats && number < 0 ? ~number : number);
    }
    if (any == 0) return 0;
    const int zeros = std::countr_zero(any);
    // For a negative float's number this takes zeros off its complement.
    for (std::size_t i = 0; i < count_; ++i) points_[i][axis] >>= zeros;
    return static_cast<std::uint8_t>(zeros);
  }

 private:
  static constexpr std::size_t kMost = std::size_t{kClusterFaces} * 4;
  static constexpr std::size_t kSlots = 2 * kMost;  // at most half full, so that searches end
  static constexpr std::uint16_t kFree = 0xffff;

  static std::size_t hash(const Point& point) {
    // Fibonacci hashing: 2^64 over the golden ratio.
    std::uint64_t mixed = 0;
    for (const Number x : point) {
      mixed = (mixed ^ static_cast<std::make_unsigned_t<Number>>(x)) * 0x9e3779b97f4a7c15u;
      mixed ^= mixed >> 32;
    }
    return mixed;
  }

  std::array<std::uint16_t, kSlots> slots_;
  std::array<Point, kMost> points_;
  std::uint16_t count_ = 0;
};

class BitWriter {
 public:
  explicit BitWriter(std::vector<std::byte>& out) : out_(out), at_(8 * out.size()) {}

  void put(std::uint64_t value, std::uint32_t width) {
    out_.resize((at_ + width + 7) / 8);
    write_bits(out_.data(), at_, width, value);
    at_ += width;
  }
  [[nodiscard]] std::uint64_t position() const { return at_; }

 private:
  std::vector<std::byte>& out_;
  std::uint64_t at_;
};

// Appends clusters to `out`, one after another.
template <class Number>
class ClusterEncoder {
 public:
  ClusterEncoder(std::vector<std::byte>& out, bool may_have_quads, bool are_floats)
      : out_(out), may_have_quads_(may_have_quads), are_floats_(are_floats) {}

  // Appends the bytes of a cluster.
  void encode(std::span<const ClusterFace> faces, ClusterVertices<Number>& vertices) {
    vertices_ = &vertices;
    header_ = {};
    name_vertices(faces, kMostLeafReferences);
    choose_own_bits();
    if (1u << header_.own_bits < most_owned()) name_vertices(faces, 1u << header_.own_bits);
    choose_fields();
    write_leaves();
    write_header();
    write_table();
    out_.insert(out_.end(), bytes_.begin(), bytes_.end());
    while (out_.size() % kClusterUnit != 0) out_.push_back(std::byte{0});
  }

 private:
  // The leaf that stores a vertex for others, and its number there.
  struct Owner {
    static constexpr std::uint32_t kNone = 0xffffffffu;
    std::uint32_t leaf = kNone;
    std::uint32_t number = 0;
  };
  // Leads to the next vertex that the leaf stores, or to one of leaf `slot`: 0 for itself, i for
  // the i-th other.
  struct Reference {
    bool is_new = false;
    std::uint16_t vertex = 0;
    std::uint32_t slot = 0;
    std::uint32_t number = 0;  // in that leaf
  };
  struct Leaf {
    std::array<Step, kLeafFaces> steps;  // to each face; the first is apart
    std::uint32_t faces = 0;
    std::uint32_t quads = 0;            // bit f: face f is one
    std::vector<Reference> references;  // in the order that they are stored
    std::vector<std::uint32_t> others;  // leaves
    std::uint32_t owned = 0;            // vertices that it stores
    std::size_t start = 0;              // where its faces begin

    template <class Visitor>
    void for_owned(Visitor&& visit) const {
      for (const Reference& each : references) {
        if (each.is_new) visit(each.vertex);
      }
    }
  };

  [[nodiscard]] std::uint32_t most_owned() const {
    std::uint32_t most = 1;
    for (const Leaf& leaf : leaves_) most = std::max(most, leaf.owned);
    return most;
  }

  // Vertices from number `limit` on of a leaf are not named by others, which store them again.
  void name_vertices(std::span<const ClusterFace> faces, std::uint32_t limit) {
    owner_.assign(vertices_->count(), Owner{});
    leaves_.clear();
    for (std::size_t first = 0; first < faces.size(); first += kLeafFaces) {
      name_vertices_of_leaf(
          faces.subspan(first, std::min<std::size_t>(kLeafFaces, faces.size() - first)), limit);
    }
  }

  void name_vertices_of_leaf(std::span<const ClusterFace> faces, std::uint32_t limit) {
    const auto number = static_cast<std::uint32_t>(leaves_.size());
    Leaf& leaf = leaves_.emplace_back();
    leaf.faces = static_cast<std::uint32_t>(faces.size());
    leaf.references.reserve(2 * kLeafFaces);
    const auto refer = [&](std::uint16_t vertex) { this->refer(vertex, number, limit, leaf); };
    for (std::size_t f = 0; f < faces.size(); ++f) {
      if (f != 0) leaf.steps[f] = step_between(faces[f - 1], leaf.steps[f - 1].turn, faces[f]);
      leaf.quads |= (faces[f].is_quad ? 1u : 0u) << f;
      refer(faces[f].corner[leaf.steps[f].brings()]);
    }
    for (std::size_t f = 0; f < faces.size(); ++f) {
      if (!leaf.steps[f].is_apart()) continue;
      refer(faces[f].corner[0]);
      refer(faces[f].corner[1]);
    }
    for (const ClusterFace& face : faces) {
      if (face.is_quad) refer(face.corner[3]);
    }
  }

  void refer(std::uint16_t vertex, std::uint32_t number, std::uint32_t limit, Leaf& leaf) {
    Owner& owner = owner_[vertex];
    if (owner.leaf == number) {
      leaf.references.push_back({false, vertex, 0, owner.number});
      return;
    }
    if (owner.leaf != Owner::kNone) {
      const auto other = std::find(leaf.others.begin(), leaf.others.end(), owner.leaf);
      const bool is_known = other != leaf.others.end();
      const auto slot = static_cast<std::uint32_t>(other - leaf.others.begin()) + 1;
      if (!is_known && slot <= kMaxOtherLeaves) leaf.others.push_back(owner.leaf);
      if (slot <= kMaxOtherLeaves) {
        leaf.references.push_back({false, vertex, slot, owner.number});
        return;
      }
    }
    if (leaf.owned < limit) owner = {number, leaf.owned};
    leaf.references.push_back({true, vertex, 0, leaf.owned++});
  }

  // Narrower numbers of vertices in a leaf save a bit for each that is named again, and cost a
  // vertex that is stored again for each that has no number any more.
  void choose_own_bits() {
    std::array<std::uint32_t, kMostLeafReferences> named{};  // vertices, by their largest number
    std::uint32_t places = 0;
    is_named_.assign(vertices_->count(), false);
    for (const Leaf& leaf : leaves_) {
      for (const Reference& each : leaf.references) {
        if (each.is_new) continue;
        ++places;
        if (is_named_[each.vertex]) continue;
        is_named_[each.vertex] = true;
        ++named[each.number];
      }
    }
    std::uint32_t again = 0;
    std::uint64_t least = ~std::uint64_t{0};
    std::uint32_t number = most_owned();
    for (std::uint32_t bits = width_below(number) + 1; bits-- > 0;) {
      while (number > 1u << bits) again += named[--number];
      const std::uint64_t cost = std::uint64_t{places} * bits + std::uint64_t{again} * stride_;
      if (cost > least) break;
      least = cost;
      header_.own_bits = static_cast<std::uint8_t>(bits);
    }
  }

  [[nodiscard]] std::uint64_t offset_of(std::uint16_t vertex, std::size_t axis) const {
    // Unsigned: the difference of two numbers of 64 bits may not fit with a sign.
    return static_cast<std::uint64_t>((*vertices_)[vertex][axis]) -
           static_cast<std::uint64_t>(origin_[axis]);
  }

  void choose_fields() {
    ranges_.assign(3 * leaves_.size(), {});
    for (std::size_t k = 0; k < 3; ++k) {
      header_.trailing[k] = vertices_->take_trailing_zeros(k, are_floats_);
      origin_[k] = (*vertices_)[0][k];
      for (std::size_t v = 0; v < vertices_->count(); ++v) {
        origin_[k] = std::min(origin_[k], (*vertices_)[v][k]);
      }
      for (std::size_t i = 0; i < leaves_.size(); ++i) {
        AxisRange& range = ranges_[k * leaves_.size() + i];
        range.low = ~std::uint64_t{0};
        range.vertices = leaves_[i].owned;
        leaves_[i].for_owned([&](std::uint16_t vertex) {
          range.low = std::min(range.low, offset_of(vertex, k));
          range.high = std::max(range.high, offset_of(vertex, k));
        });
      }
      const AxisFields fields =
          best_fields(std::span(ranges_).subspan(k * leaves_.size(), leaves_.size()));
      header_.base_bits[k] = fields.base_bits;
      base_shift_[k] = fields.base_shift;
      header_.base_shift[k] = fields.base_bits == 0 ? std::uint8_t{0} : fields.base_shift;
      header_.width[k] = fields.width;
      header_.wider_bits[k] = fields.wider_bits;
    }
  }

  [[nodiscard]] const AxisRange& range(std::size_t leaf, std::size_t axis) const {
    return ranges_[axis * leaves_.size() + leaf];
  }
  // How many bits more than the narrowest leaf.
  [[nodiscard]] std::uint32_t wider(std::size_t leaf, std::size_t axis) const {
    const std::uint32_t width = range(leaf, axis).width(base_shift_[axis]);
    return std::max<std::uint32_t>(width, header_.width[axis]) - header_.width[axis];
  }

  void write_leaves() {
    bytes_.clear();
    std::size_t last_bit = 0;
    std::uint64_t vertex_bits = 0, vertices = 0;
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
      Leaf& leaf = leaves_[i];
      std::array<std::uint32_t, 3> width;
      std::uint32_t stride = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        width[k] = header_.width[k] + wider(i, k);
        stride += width[k];
      }
      const std::size_t bits_of_vertices = std::size_t{leaf.owned} * stride;
      vertex_bits += bits_of_vertices;
      vertices += leaf.owned;
      leaf.start = (last_bit + bits_of_vertices + 7) / 8;
      bytes_.resize(leaf.start);
      std::size_t end = leaf.start * 8;
      leaf.for_owned([&](std::uint16_t vertex) {
        end -= stride;
        std::size_t at = end;
        for (std::size_t k = 0; k < 3; ++k) {
          const std::uint32_t shift = base_shift_[k];
          const std::uint64_t offset = offset_of(vertex, k) - (range(i, k).base(shift) << shift);
          write_bits(bytes_.data(), at, width[k], offset);
          at += width[k];
        }
      });
      BitWriter bits(bytes_);
      write_faces(static_cast<std::uint32_t>(i), bits);
      last_bit = bits.position();
    }
    if (vertices != 0) stride_ = vertex_bits / vertices;
  }

  void write_faces(std::uint32_t number, BitWriter& bits) {
    const Leaf& leaf = leaves_[number];
    if (may_have_quads_) bits.put(leaf.quads, leaf.faces);
    for (std::size_t f = 1; f < leaf.faces; ++f) bits.put(leaf.steps[f].code, StripStep::kBits);
    for (std::size_t r = 0; r < leaf.faces; ++r) bits.put(leaf.references[r].is_new ? 1 : 0, 1);
    bits.put(leaf.others.size(), kOtherBits);
    for (const std::uint32_t other : leaf.others) bits.put(other, width_below(number));
    for (std::size_t r = leaf.faces; r < leaf.references.size(); ++r) {
      bits.put(leaf.references[r].is_new ? 1 : 0, 1);
    }
    for (const Reference& each : leaf.references) {
      if (each.is_new) continue;
      bits.put(each.slot, width_below(leaf.others.size() + 1));
      bits.put(each.number, header_.own_bits);
    }
  }

  void write_header() {
    std::size_t least = std::numeric_limits<std::uint16_t>::max();
    for (std::size_t i = 1; i < leaves_.size(); ++i) least = std::min(least, leaves_[i].start / i);
    if (leaves_.size() == 1) least = 0;
    std::size_t most = 0;
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
      most = std::max(most, leaves_[i].start - i * least);
    }
    header_.leaf_bytes = static_cast<std::uint16_t>(least);
    header_.start_bits = static_cast<std::uint8_t>(std::bit_width(most));
    assert(header_.start_bits <= ClusterHeader::kMostStartBits);
    append(header_);
    append(origin_);
  }

  template <class T>
  void append(const T& value) {
    const auto bytes = std::as_bytes(std::span(&value, 1));
    out_.insert(out_.end(), bytes.begin(), bytes.end());
  }

  void write_table() {
    BitWriter bits(out_);
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
      bits.put(leaves_[i].start - i * header_.leaf_bytes, header_.start_bits);
      for (std::size_t k = 0; k < 3; ++k) {
        bits.put(range(i, k).base(base_shift_[k]), header_.base_bits[k]);
        bits.put(wider(i, k), header_.wider_bits[k]);
      }
    }
  }

  std::vector<std::byte>& out_;
  bool may_have_quads_;
  bool are_floats_;
  ClusterVertices<Number>* vertices_ = nullptr;
  ClusterHeader header_{};
  std::array<Number, 3> origin_{};
  std::array<std::uint32_t, 3> base_shift_{};  // also where no leaf has a base but 0
  std::vector<Owner> owner_;                   // of each vertex
  std::vector<bool> is_named_;                 // by vertex
  std::uint64_t stride_ = 32;                  // mean bits of a vertex in the cluster before
  std::vector<Leaf> leaves_;
  std::vector<AxisRange> ranges_;  // [axis][leaf]
  std::vector<std::byte> bytes_;   // of leaves
};

// Clusters encoded by one task.
struct Block {
  std::vector<std::uint32_t> offsets;
  std::vector<std::byte> bytes;
};

// The number of a float that keeps the order of floats; see float_of_number.
template <class Number, class Float>
Number number_of(Float value) {
  const auto bits = std::bit_cast<Number>(value);
  constexpr Number kMagnitude = std::numeric_limits<Number>::max();
  return bits < 0 ? static_cast<Number>(~(bits & kMagnitude)) : bits;
}

// The coordinates of source vertices as numbers.
struct GridNumbers {
  using Number = std::int32_t;
  static constexpr bool kAreFloats = false;
  const Positions& positions;

  [[nodiscard]] std::array<Number, 3> operator[](std::uint32_t vertex) const {
    const Eigen::Vector3d position = positions[vertex];
    std::array<Number, 3> point;
    for (std::size_t k = 0; k < 3; ++k) {
      const double q = position[static_cast<Eigen::Index>(k)];
      assert(q == std::floor(q) && std::abs(q) <= 1 << 30);
      point[k] = static_cast<Number>(q);
    }
    return point;
  }
};

template <class Whole, class Float>
struct FloatNumbers {
  using Number = Whole;
  static constexpr bool kAreFloats = true;
  std::span<const Float> positions;

  [[nodiscard]] std::array<Number, 3> operator[](std::uint32_t vertex) const {
    std::array<Number, 3> point;
    for (std::size_t k = 0; k < 3; ++k) {
      point[k] = number_of<Number>(positions[std::size_t{3} * vertex + k]);
    }
    return point;
  }
};

template <class Numbers>
Block encode_block(const SourceMesh& mesh, const Numbers& numbers, std::span<std::uint32_t> order,
                   bool may_have_quads, LeafOrder leaf_order) {
  using Number = typename Numbers::Number;
  Block block;
  ClusterEncoder<Number> encoder(block.bytes, may_have_quads, Numbers::kAreFloats);
  for (std::size_t first = 0; first < order.size(); first += kClusterFaces) {
    const std::span<std::uint32_t> of_cluster =
        order.subspan(first, std::min<std::size_t>(kClusterFaces, order.size() - first));
    ClusterVertices<Number> vertices;
    std::vector<ClusterFace> faces;
    for (const std::uint32_t source : of_cluster) {
      const Face& face = mesh.faces[source];
      ClusterFace named{{}, source, face.is_quad()};
      for (std::size_t c = 0; c < (named.is_quad ? 4u : 3u); ++c) {
        named.corner[c] = vertices.number_of(numbers[face.corner[c]]);
      }
      faces.push_back(named);
    }
    for (std::size_t leaf = 0; leaf < faces.size(); leaf += kLeafFaces) {
      const std::size_t count = std::min<std::size_t>(kLeafFaces, faces.size() - leaf);
      if (leaf_order == LeafOrder::kFree) order_as_strip(std::span(faces).subspan(leaf, count));
    }
    for (std::size_t i = 0; i < faces.size(); ++i) of_cluster[i] = faces[i].source;
    block.offsets.push_back(static_cast<std::uint32_t>(block.bytes.size() / kClusterUnit));
    encoder.encode(faces, vertices);
  }
  return block;
}

template <class Numbers>
EncodedGeometry encode_clusters(const SourceMesh& mesh, const Numbers& numbers,
                                std::vector<std::uint32_t>& order, LeafOrder leaf_order) {
  const bool may_have_quads = std::any_of(mesh.faces.begin(), mesh.faces.end(),
                                          [](const Face& face) { return face.is_quad(); });
  EncodedGeometry out;
  out.corners_per_face = may_have_quads ? 4 : 3;
  constexpr std::size_t kBlockFaces = std::size_t{16} * kClusterFaces;
  std::vector<Block> blocks((order.size() + kBlockFaces - 1) / kBlockFaces);
  const auto encode = [&](std::size_t i) {
    const std::size_t first = i * kBlockFaces;
    const std::size_t count = std::min(kBlockFaces, order.size() - first);
    blocks[i] = encode_block(mesh, numbers, std::span(order).subspan(first, count), may_have_quads,
                             leaf_order);
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks.size(), 1),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i) encode(i);
                    });
  if (blocks.empty()) return out;
  const std::size_t table = cluster_table_bytes(static_cast<std::uint32_t>(order.size()));
  std::size_t bytes = table + kClusterPadding;
  for (const Block& block : blocks) bytes += block.bytes.size();
  out.vertices.reserve(bytes);
  std::size_t end = table;
  for (Block& block : blocks) {
    const auto offset = static_cast<std::uint32_t>(end / kClusterUnit);
    for (std::uint32_t& of_cluster : block.offsets) of_cluster += offset;
    const Bytes offsets = std::as_bytes(std::span(block.offsets));
    out.vertices.insert(out.vertices.end(), offsets.begin(), offsets.end());
    end += block.bytes.size();
  }
  for (Block& block : blocks) {
    out.vertices.insert(out.vertices.end(), block.bytes.begin(), block.bytes.end());
    block = {};
  }
  out.vertices.resize(bytes);
  return out;
}

}  // namespace

EncodedGeometry encode_grid_geometry(const QuantisedMesh& quantised,
                                     std::vector<std::uint32_t>& order, LeafOrder leaf_order) {
  EncodedGeometry out =
      encode_clusters(quantised.mesh, GridNumbers{quantised.mesh.positions}, order, leaf_order);
  out.geometry = GeometryId::kGrid;
  out.grid_exponent = quantised.step_exponent;
  out.max_vertex_error = quantised.max_vertex_error;
  return out;
}

EncodedGeometry encode_exact_geometry(const SourceMesh& mesh, std::vector<std::uint32_t>& order,
                                      LeafOrder leaf_order) {
  const Positions& positions = mesh.positions;
  EncodedGeometry out =
      positions.precision == Precision::kF64
          ? encode_clusters(mesh, FloatNumbers<std::int64_t, double>{positions.f64}, order,
                            leaf_order)
          : encode_clusters(mesh, FloatNumbers<std::int32_t, float>{positions.f32}, order,
                            leaf_order);
  out.geometry = GeometryId::kExact;
  return out;
}

}  // namespace boxtree::cooker
