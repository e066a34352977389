// SPDX-License-Identifier: MIT
// Decoding of one leaf of the grid store (encoder: cooker/encode/grid_geometry.cpp).
#include <algorithm>
#include <bit>

#include <boxtree/format/bits.h>
#include <boxtree/format/grid.h>

namespace boxtree {
namespace {

// Why no read leaves the section: where leaves start is told in at most 34 bytes; a leaf starts
// inside the bytes of its cluster, which end at least kClusterPadding before the section does, and
// has at most 32 references of 11 bits, 8 steps of 5 and one number of 9: 401 bits.
static_assert(kClusterPadding >= 433 / 8 + 1 + 8);

// Bits of a number below `count`.
std::uint32_t width_below(std::uint32_t count) {
  return count == 0 ? 0 : static_cast<std::uint32_t>(std::bit_width(count - 1));
}

// Reads the fields of a leaf one after the other. A window of bits is enough for a face: a step of
// 5 bits and four references of at most 12: numbers are below 2^10 on any bytes, as a leaf cannot
// name more than 32 new vertices after the 512 that a cluster may have.
class LeafBits {
 public:
  LeafBits(const std::byte* bytes, std::uint64_t position) : bytes_(bytes), position_(position) {}

  void refill() { window_ = load<std::uint64_t>(bytes_ + position_ / 8) >> (position_ % 8); }
  [[nodiscard]] std::uint64_t window() const { return window_; }
  void skip(std::uint32_t width) {
    window_ >>= width;
    position_ += width;
  }
  [[nodiscard]] std::uint32_t take(std::uint32_t width) {
    const auto field = static_cast<std::uint32_t>(window_ & ((std::uint64_t{1} << width) - 1));
    skip(width);
    return field;
  }

 private:
  const std::byte* bytes_;
  std::uint64_t position_;
  std::uint64_t window_ = 0;
};

// The vertices that a leaf has named so far, by their numbers in the cluster.
class LeafVertices {
 public:
  LeafVertices(std::uint32_t first_new, std::uint32_t vertex_count)
      : next_(first_new), vertex_count_(vertex_count) {}

  // A reference: 1 for the vertex of the cluster that follows the last one named so; 01 and the
  // number of a vertex of the cluster before that one; 00 and the place of a vertex that this leaf
  // has named before. Which of them comes is anybody's guess, so nothing here is a branch.
  [[nodiscard]] std::uint8_t take(LeafBits& bits) {
    const auto window = static_cast<std::uint32_t>(bits.window());
    const std::uint32_t is_next = window & 1u;
    const std::uint32_t is_new = is_next | ((window >> 1) & 1u);
    const std::uint32_t width =
        (is_next - 1) & (is_new != 0 ? width_below(next_) : width_below(count_));
    const std::uint32_t field = (window >> 2) & ((1u << width) - 1);
    bits.skip(2 - is_next + width);
    const std::uint32_t vertex = is_next != 0 ? next_ : field;
    const std::uint32_t place = is_new != 0 ? count_ : field;
    number_[count_] = static_cast<std::uint16_t>(vertex);
    unsound_ |= (is_new & (vertex >= vertex_count_ ? 1u : 0u)) |
                ((is_new ^ 1u) & (field >= count_ ? 1u : 0u));
    count_ += is_new;
    next_ += is_next;
    return static_cast<std::uint8_t>(place);
  }

  [[nodiscard]] bool sound() const { return unsound_ == 0; }
  [[nodiscard]] std::uint32_t count() const { return count_; }
  [[nodiscard]] std::uint32_t number(std::uint32_t i) const { return number_[i]; }

 private:
  std::array<std::uint16_t, kMaxLeafVertices + 1> number_;  // the last is written and never read
  std::uint32_t count_ = 0;
  std::uint32_t next_;
  std::uint32_t vertex_count_;
  std::uint32_t unsound_ = 0;
};

// The face after `previous`; false for a code that is none.
bool take_face(LeafBits& bits, LeafVertices& vertices, bool may_be_quad,
               const std::array<std::uint8_t, 4>* previous, std::array<std::uint8_t, 4>& face) {
  const bool is_quad = may_be_quad && bits.take(1) != 0;
  const std::uint32_t step = previous == nullptr ? StripStep::kApart : bits.take(StripStep::kBits);
  if (step > StripStep::kApart) return false;
  if (step == StripStep::kApart) {
    for (std::size_t i = 0; i < 3; ++i) face[i] = vertices.take(bits);
  } else {
    const std::uint32_t edge = step / 3;
    const std::uint32_t turn = step % 3;
    face[turn] = (*previous)[edge == 2 ? 0 : edge + 1];
    face[turn == 2 ? 0 : turn + 1] = (*previous)[edge];
    face[turn == 0 ? 2 : turn - 1] = vertices.take(bits);
  }
  face[3] = is_quad ? vertices.take(bits) : GridLeaf::kNoCorner;
  return vertices.sound();
}

void read_positions(const ClusterRecord& cluster, const std::byte* bytes, std::uint64_t start,
                    const LeafVertices& vertices, GridLeaf& out) {
  const std::array<std::uint8_t, 3>& width = cluster.width;
  const std::uint32_t stride = std::uint32_t{width[0]} + width[1] + width[2];
  constexpr std::uint32_t kOneLoad = 57;
  for (std::uint32_t i = 0; i < vertices.count(); ++i) {
    const std::uint64_t at = start + std::uint64_t{vertices.number(i)} * stride;
    std::array<std::uint64_t, 3> offset;
    if (stride <= kOneLoad) {
      const std::uint64_t fields = load<std::uint64_t>(bytes + at / 8) >> (at % 8);
      offset = {fields & low_bits(width[0]), (fields >> width[0]) & low_bits(width[1]),
                (fields >> (width[0] + width[1])) & low_bits(width[2])};
    } else {
      offset = {read_bits(bytes, at, width[0]), read_bits(bytes, at + width[0], width[1]),
                read_bits(bytes, at + width[0] + width[1], width[2])};
    }
    // Unsigned, so that corrupt sums wrap.
    for (std::size_t k = 0; k < 3; ++k) {
      out.position[i][k] = static_cast<std::int32_t>(static_cast<std::uint32_t>(cluster.origin[k]) +
                                                     static_cast<std::uint32_t>(offset[k]));
    }
    out.position[i][3] = 0;
  }
}

}  // namespace

bool decode_grid_leaf(const GridView& grid, std::uint32_t leaf, GridLeaf& out) noexcept {
  const auto cluster = load<ClusterRecord>(grid.clusters, leaf / kClusterLeaves);
  const std::uint64_t start = cluster.offset * kClusterUnit;
  if (cluster.leaf_bits > 16 || !in_range(start, kClusterPadding, grid.bytes.size())) return false;
  const std::byte* const bytes = grid.bytes.data();
  const std::uint32_t faces_left = grid.face_count - leaf / kClusterLeaves * kClusterFaces;
  const std::uint32_t leaves = (std::min(faces_left, kClusterFaces) + kLeafFaces - 1) / kLeafFaces;
  const std::uint64_t first_leaf = ((leaves + 1) * cluster.leaf_bits + 7) / 8;
  const auto start_of = [&](std::uint32_t i) {  // bytes after the start of the cluster
    return first_leaf + i * cluster.leaf_bytes +
           read_bits(bytes, start * 8 + i * cluster.leaf_bits, cluster.leaf_bits);
  };
  const std::uint64_t leaf_at = start_of(leaf % kClusterLeaves);
  const std::uint64_t vertices_at = start_of(leaves);
  const std::uint32_t widest = std::max({cluster.width[0], cluster.width[1], cluster.width[2]});
  const std::uint64_t stride =
      std::uint64_t{cluster.width[0]} + cluster.width[1] + cluster.width[2];
  const std::uint64_t size = vertices_at + (cluster.vertex_count * stride + 7) / 8;
  constexpr std::uint32_t kMostVertices = kClusterFaces * 4;
  if (widest > 32 || cluster.vertex_count == 0 || cluster.vertex_count > kMostVertices ||
      leaf_at > vertices_at || !in_range(start, size + kClusterPadding, grid.bytes.size())) {
    return false;
  }
  LeafBits bits(bytes, (start + leaf_at) * 8);
  bits.refill();
  LeafVertices vertices(bits.take(width_below(cluster.vertex_count + 1u)), cluster.vertex_count);
  out.face_count = std::min(kLeafFaces, grid.face_count - leaf * kLeafFaces);
  for (std::uint32_t f = 0; f < out.face_count; ++f) {
    bits.refill();
    if (!take_face(bits, vertices, grid.corners_per_face == 4,
                   f == 0 ? nullptr : &out.corner[f - 1], out.corner[f])) {
      return false;
    }
  }
  out.vertex_count = vertices.count();
  read_positions(cluster, bytes, (start + vertices_at) * 8, vertices, out);
  return true;
}

}  // namespace boxtree
