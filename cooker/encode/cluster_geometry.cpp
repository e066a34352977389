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

#include "cooker/encode/encoded.h"
#include "cooker/encode/strip.h"
#include "cooker/encode/vertex_groups.h"
#include "cooker/import/hash_mix.h"
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
    std::uint64_t mixed = 0;
    for (const Number x : point) {
      mixed = hash_with(mixed, static_cast<std::make_unsigned_t<Number>>(x));
    }
    return mixed;
  }

  std::array<std::uint16_t, kSlots> slots_;
  std::array<Point, kMost> points_;
  std::uint16_t count_ = 0;
};

// Appends fields to bytes; the last byte is there when the writer ends.
class BitWriter {
 public:
  explicit BitWriter(std::vector<std::byte>& out) : out_(out) {}
  BitWriter(const BitWriter&) = delete;
  BitWriter& operator=(const BitWriter&) = delete;
  ~BitWriter() { append((count_ + 7) / 8); }

  void put(std::uint64_t value, std::uint32_t width) {
    if (width > kWord) {
      put(value, kWord);
      value >>= kWord;
      width -= kWord;
    }
    pending_ |= (value & low_bits(width)) << count_;
    count_ += width;
    if (count_ < kWord) return;
    append(kWord / 8);
    pending_ >>= kWord;
    count_ -= kWord;
  }

 private:
  static constexpr std::uint32_t kWord = 32;

  void append(std::size_t bytes) {
    const auto all = std::as_bytes(std::span(&pending_, 1));
    out_.insert(out_.end(), all.begin(), all.begin() + static_cast<std::ptrdiff_t>(bytes));
  }

  std::vector<std::byte>& out_;
  std::uint64_t pending_ = 0;  // fewer than kWord bits between calls
  std::uint32_t count_ = 0;    // of them
};

// Numbers n[i] as (i * slope >> kSlopeBits) - bias + rest[i], where rests are from 0 to `range`.
struct Line {
  std::uint32_t slope = 0;
  std::uint32_t bias = 0;
  std::uint32_t range = 0;

  [[nodiscard]] std::uint32_t bits() const {
    return static_cast<std::uint32_t>(std::bit_width(range));
  }
  [[nodiscard]] std::uint32_t rest(std::uint32_t number, std::uint32_t i) const {
    return number + bias - (i * slope >> ClusterHeader::kSlopeBits);
  }
};

Line line_with(std::span<const std::uint32_t> numbers, std::uint32_t slope) {
  std::int64_t least = 0, most = 0;
  for (std::uint32_t i = 0; i < numbers.size(); ++i) {
    const std::int64_t rest = std::int64_t{numbers[i]} - (i * slope >> ClusterHeader::kSlopeBits);
    least = std::min(least, rest);
    most = std::max(most, rest);
  }
  return {slope, static_cast<std::uint32_t>(-least), static_cast<std::uint32_t>(most - least)};
}

// The line with the least range of rests, which is convex over slopes but for what is rounded off:
// searched in halved steps from the one to the last number. Precondition: numbers rise from 0.
Line best_line(std::span<const std::uint32_t> numbers, std::uint32_t most_slope) {
  const auto last = static_cast<std::uint32_t>(numbers.size() - 1);
  if (last == 0) return line_with(numbers, 0);
  const std::uint32_t mean = static_cast<std::uint32_t>(
      (std::uint64_t{numbers[last]} << ClusterHeader::kSlopeBits) / last);
  Line best = line_with(numbers, std::min(mean, most_slope));
  for (std::uint32_t step = 16; step != 0; step /= 2) {
    for (const std::uint32_t slope : {best.slope - std::min(step, best.slope), best.slope + step}) {
      const Line other = line_with(numbers, std::min(slope, most_slope));
      if (other.range < best.range) best = other;
    }
  }
  return best;
}

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
    number_vertices(faces);
    choose_groups();
    write_vertices();
    write_leaves();
    const std::size_t begin = out_.size();
    write_header();
    write_table();
    write_groups();
    out_.insert(out_.end(), vertex_bytes_.begin(), vertex_bytes_.end());
    const auto leaves_at = static_cast<std::uint16_t>(out_.size() - begin);
    std::memcpy(out_.data() + begin + offsetof(ClusterHeader, leaves_at), &leaves_at,
                sizeof(leaves_at));
    out_.insert(out_.end(), leaf_bytes_.begin(), leaf_bytes_.end());
    while (out_.size() % kClusterUnit != 0) out_.push_back(std::byte{0});
  }

 private:
  // Leads to the next vertex that no leaf before has used, or to the one that is so many before the
  // last of these.
  struct Reference {
    bool is_new = false;
    std::uint32_t number = 0;  // in the cluster
  };
  struct Leaf {
    std::array<Step, kLeafFaces> steps;  // to each face; the first is apart
    std::uint32_t faces = 0;
    std::uint32_t quads = 0;  // bit f: face f is one
    std::array<Reference, kMostLeafReferences> references;
    std::uint32_t reference_count = 0;
    std::uint32_t end = 0;       // vertices that it or a leaf before uses
    std::uint32_t old_bits = 0;  // that its old references need

    [[nodiscard]] std::span<const Reference> all() const {
      return std::span(references).first(reference_count);
    }
  };
  static constexpr std::uint32_t kNoNumber = 0xffffffffu;

  void number_vertices(std::span<const ClusterFace> faces) {
    number_.assign(vertices_->count(), kNoNumber);
    order_.clear();
    leaves_.clear();
    firsts_.clear();
    for (std::size_t first = 0; first < faces.size(); first += kLeafFaces) {
      firsts_.push_back(static_cast<std::uint32_t>(order_.size()));
      number_vertices_of_leaf(
          faces.subspan(first, std::min<std::size_t>(kLeafFaces, faces.size() - first)));
    }
    std::uint32_t most = 0;
    for (const Leaf& leaf : leaves_) most = std::max(most, leaf.old_bits);
    constexpr std::uint32_t kMostWider = (1u << kOldWiderBits) - 1;
    header_.old_bits = static_cast<std::uint8_t>(most - std::min(most, kMostWider));
    first_line_ = best_line(firsts_, std::numeric_limits<std::uint8_t>::max());
    header_.first_slope = static_cast<std::uint8_t>(first_line_.slope);
    header_.first_bias = static_cast<std::uint16_t>(first_line_.bias);
    header_.first_bits = static_cast<std::uint8_t>(first_line_.bits());
    assert(header_.first_bits <= ClusterHeader::kMostFirstBits);
  }

  void number_vertices_of_leaf(std::span<const ClusterFace> faces) {
    Leaf& leaf = leaves_.emplace_back();
    leaf.faces = static_cast<std::uint32_t>(faces.size());
    const auto refer = [&](std::uint16_t vertex) {
      const bool is_new = number_[vertex] == kNoNumber;
      if (is_new) {
        number_[vertex] = static_cast<std::uint32_t>(order_.size());
        order_.push_back(vertex);
      }
      leaf.references[leaf.reference_count++] = {is_new, number_[vertex]};
    };
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
    leaf.end = static_cast<std::uint32_t>(order_.size());
    std::uint32_t farthest = 0;
    for (const Reference& each : leaf.all()) {
      if (!each.is_new) farthest = std::max(farthest, leaf.end - 1 - each.number);
    }
    leaf.old_bits = static_cast<std::uint32_t>(std::bit_width(farthest));
  }

  void choose_groups() {
    offsets_.assign(order_.size(), {});
    for (std::size_t k = 0; k < 3; ++k) {
      header_.trailing[k] = vertices_->take_trailing_zeros(k, are_floats_);
      origin_[k] = (*vertices_)[0][k];
      for (std::size_t v = 0; v < vertices_->count(); ++v) {
        origin_[k] = std::min(origin_[k], (*vertices_)[v][k]);
      }
      for (std::size_t i = 0; i < order_.size(); ++i) {
        // Unsigned: the difference of two numbers of 64 bits may not fit with a sign.
        offsets_[i][k] = static_cast<std::uint64_t>((*vertices_)[order_[i]][k]) -
                         static_cast<std::uint64_t>(origin_[k]);
      }
    }
    groups_ = best_groups(offsets_);
    header_.base_shift = groups_.base_shift;
    header_.width = groups_.narrowest;
    header_.group_size = static_cast<std::uint8_t>(groups_.size);
    header_.vertex_count = static_cast<std::uint16_t>(order_.size());
  }

  void write_vertices() {
    vertex_bytes_.clear();
    for (std::size_t i = 0; i < offsets_.size(); i += groups_.size) {
      const VertexGroup& group = groups_.group[i / groups_.size];
      BitWriter bits(vertex_bytes_);
      for (std::size_t v = i; v < std::min<std::size_t>(i + groups_.size, offsets_.size()); ++v) {
        for (std::size_t k = 0; k < 3; ++k) {
          bits.put(offsets_[v][k] - (group.base[k] << groups_.base_shift[k]), group.width[k]);
        }
      }
    }
  }

  void write_leaves() {
    leaf_bytes_.clear();
    starts_.clear();
    for (const Leaf& leaf : leaves_) {
      starts_.push_back(static_cast<std::uint32_t>(leaf_bytes_.size()));
      BitWriter bits(leaf_bytes_);
      if (may_have_quads_) bits.put(leaf.quads, leaf.faces);
      for (std::size_t f = 1; f < leaf.faces; ++f) bits.put(leaf.steps[f].code, StripStep::kBits);
      const auto all = leaf.all();
      for (const Reference& each : all.first(leaf.faces)) bits.put(each.is_new ? 1 : 0, 1);
      const std::uint32_t old_bits = std::max<std::uint32_t>(leaf.old_bits, header_.old_bits);
      bits.put(old_bits - header_.old_bits, kOldWiderBits);
      for (const Reference& each : all.subspan(leaf.faces)) bits.put(each.is_new ? 1 : 0, 1);
      for (const Reference& each : all) {
        if (!each.is_new) bits.put(leaf.end - 1 - each.number, old_bits);
      }
    }
    start_line_ = best_line(starts_, std::numeric_limits<std::uint16_t>::max());
    header_.start_slope = static_cast<std::uint16_t>(start_line_.slope);
    header_.start_bias = static_cast<std::uint16_t>(start_line_.bias);
    header_.start_bits = static_cast<std::uint8_t>(start_line_.bits());
    assert(header_.start_bits <= ClusterHeader::kMostStartBits);
  }

  void write_header() {
    append(header_);
    append(origin_);
  }

  template <class T>
  void append(const T& value) {
    const auto bytes = std::as_bytes(std::span(&value, 1));
    out_.insert(out_.end(), bytes.begin(), bytes.end());
  }

  void write_groups() {
    for (std::size_t k = 0; k < 3; ++k) {
      for (const VertexGroup& group : groups_.group) {
        append(static_cast<std::uint8_t>(group.base[k]));
      }
    }
    for (std::size_t k = 0; k < 3; ++k) {
      BitWriter bits(out_);
      for (const VertexGroup& group : groups_.group) {
        bits.put(group.width[k] - groups_.narrowest[k], ClusterHeader::kWiderBits);
      }
    }
  }

  void write_table() {
    BitWriter bits(out_);
    for (std::uint32_t i = 0; i < leaves_.size(); ++i) {
      bits.put(start_line_.rest(starts_[i], i), start_line_.bits());
      bits.put(first_line_.rest(firsts_[i], i), first_line_.bits());
    }
  }

  std::vector<std::byte>& out_;
  bool may_have_quads_;
  bool are_floats_;
  ClusterVertices<Number>* vertices_ = nullptr;
  ClusterHeader header_{};
  std::array<Number, 3> origin_{};
  std::vector<std::uint32_t> number_;  // of each vertex, in the order in which leaves use them
  std::vector<std::uint16_t> order_;   // the vertex of each number
  std::vector<std::array<std::uint64_t, 3>> offsets_;  // by number
  VertexGroups groups_;
  std::vector<Leaf> leaves_;
  std::vector<std::uint32_t> firsts_;  // by leaf: the first number that it may use first
  std::vector<std::uint32_t> starts_;  // by leaf: its byte
  Line first_line_, start_line_;
  std::vector<std::byte> vertex_bytes_;
  std::vector<std::byte> leaf_bytes_;
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
  std::array<Float, 3> origin;  // no difference from it is rounded

  [[nodiscard]] std::array<Number, 3> operator[](std::uint32_t vertex) const {
    std::array<Number, 3> point;
    for (std::size_t k = 0; k < 3; ++k) {
      // Keeps -0 where the origin is 0.
      point[k] = number_of<Number>(positions[std::size_t{3} * vertex + k] - origin[k]);
    }
    return point;
  }
};

template <class Numbers>
Block encode_block(std::span<const Face> mesh_faces, const Numbers& numbers,
                   std::span<std::uint32_t> order, bool may_have_quads, LeafOrder leaf_order) {
  using Number = typename Numbers::Number;
  Block block;
  ClusterEncoder<Number> encoder(block.bytes, may_have_quads, Numbers::kAreFloats);
  std::vector<ClusterFace> faces;
  for (std::size_t first = 0; first < order.size(); first += kClusterFaces) {
    const std::span<std::uint32_t> of_cluster =
        order.subspan(first, std::min<std::size_t>(kClusterFaces, order.size() - first));
    ClusterVertices<Number> vertices;
    faces.clear();
    for (const std::uint32_t source : of_cluster) {
      const Face& face = mesh_faces[source];
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
EncodedGeometry encode_clusters(std::span<const Face> faces, const Numbers& numbers,
                                std::vector<std::uint32_t>& order, LeafOrder leaf_order) {
  const bool may_have_quads =
      std::any_of(faces.begin(), faces.end(), [](const Face& face) { return face.is_quad(); });
  EncodedGeometry out;
  out.corners_per_face = may_have_quads ? 4 : 3;
  constexpr std::size_t kBlockFaces = std::size_t{16} * kClusterFaces;
  std::vector<Block> blocks((order.size() + kBlockFaces - 1) / kBlockFaces);
  const auto encode = [&](std::size_t i) {
    const std::size_t first = i * kBlockFaces;
    const std::size_t count = std::min(kBlockFaces, order.size() - first);
    blocks[i] = encode_block(faces, numbers, std::span(order).subspan(first, count), may_have_quads,
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

EncodedGeometry encode_grid_geometry(std::span<const Face> faces,
                                     const QuantisedPositions& quantised,
                                     std::vector<std::uint32_t>& order, LeafOrder leaf_order) {
  EncodedGeometry out = encode_clusters(faces, GridNumbers{quantised.positions}, order, leaf_order);
  out.geometry = GeometryId::kGrid;
  out.grid_exponent = quantised.step_exponent;
  out.max_vertex_error = quantised.max_vertex_error;
  return out;
}

EncodedGeometry encode_exact_geometry(const SourceMesh& mesh, const std::array<double, 3>& origin,
                                      std::vector<std::uint32_t>& order, LeafOrder leaf_order) {
  const Positions& positions = mesh.positions;
  const auto origin_f32 = [&](std::size_t k) { return static_cast<float>(origin[k]); };
  EncodedGeometry out =
      positions.precision == Precision::kF64
          ? encode_clusters(mesh.faces, FloatNumbers<std::int64_t, double>{positions.f64, {}},
                            order, leaf_order)
          : encode_clusters(mesh.faces,
                            FloatNumbers<std::int32_t, float>{
                                positions.f32, {origin_f32(0), origin_f32(1), origin_f32(2)}},
                            order, leaf_order);
  out.geometry = GeometryId::kExact;
  out.max_vertex_error = mesh.moved_by_f32;
  return out;
}

}  // namespace boxtree::cooker
