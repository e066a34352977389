// SPDX-License-Identifier: MIT
// Decoding of one leaf of a cluster (encoder: cooker/encode/cluster_geometry.cpp).
#include "format/cluster.h"

#include "format/bits.h"
#include "format/cluster_leaf.h"

namespace boxtree {
namespace {

// Reads the fields of a leaf in order. No read leaves the section: a leaf begins where
// kClusterPadding bytes and more follow, and has at most 8 faces with a bit for a fourth corner, 7
// steps, 32 references of one bit each, 7 other leaves of 6 bits after their number, and 8 bits for
// each reference: 362 bits, after which 16 bytes are read at once.
static_assert(kClusterPadding >= 362 / 8 + 2 * kBitPadding);

class LeafDecoder {
 public:
  LeafDecoder(const ClusterView& view, ClusterLeaf& out) : view_(view), out_(out) {}

  bool run(std::uint32_t leaf, ClusterLeafFields* fields) {
    if (!find_cluster(view_, leaf / kClusterLeaves, cluster_)) return false;
    self_ = leaf % kClusterLeaves;
    if (!find_leaf(cluster_, self_, own_)) return false;
    at_ = own_.middle;
    out_.face_count = std::min(kLeafFaces, view_.face_count - leaf * kLeafFaces);
    quads_ = view_.corners_per_face == 4 ? take(out_.face_count) : 0;
    steps_ = take(StripStep::kBits * (out_.face_count - 1));
    std::uint32_t count = out_.face_count + 2 + static_cast<std::uint32_t>(std::popcount(quads_));
    for (std::uint32_t f = 1; f < out_.face_count; ++f) {
      if (step(f) > StripStep::kApart) return false;
      count += step(f) == StripStep::kApart ? 2u : 0u;
    }
    out_.vertex_count = count;
    if (!read_references()) return false;
    join_faces();
    if (fields != nullptr) {
      const auto start = static_cast<std::uint64_t>(cluster_.bytes - view_.bytes.data()) * 8;
      *fields = named_;
      fields->begin += start;
      fields->end = start + at_;
    }
    return true;
  }

 private:
  // Precondition: width <= 57.
  std::uint32_t take(std::uint32_t width) {
    const std::uint64_t field = read_bits(cluster_.bytes, at_, width);
    at_ += width;
    return static_cast<std::uint32_t>(field);
  }

  [[nodiscard]] std::uint32_t step(std::uint32_t face) const {  // from the face before
    if (face == 0) return StripStep::kApart;
    return (steps_ >> (StripStep::kBits * (face - 1))) & ((1u << StripStep::kBits) - 1);
  }

  // The vertices that references lead to: the next that the leaf stores, or one that it or another
  // leaf stores.
  bool read_references() {
    std::uint32_t is_new = take(out_.face_count);
    named_.other_count = take(kOtherBits);
    std::array<ClusterLeafPlace, 1 + kMaxOtherLeaves> places;
    places[0] = own_;
    for (std::uint32_t i = 1; i <= named_.other_count; ++i) {
      const std::uint32_t leaf = take(width_below(self_));
      if (leaf >= self_ || !find_leaf(cluster_, leaf, places[i])) return false;
      named_.others[i - 1].leaf = leaf;
    }
    is_new |= take(out_.vertex_count - out_.face_count) << out_.face_count;
    const std::uint32_t slot_bits = width_below(named_.other_count + 1);
    const std::uint32_t place_bits = slot_bits + cluster_.header.own_bits;
    const std::uint32_t slot_mask = (1u << slot_bits) - 1;
    for (std::uint32_t r = 0; r < out_.vertex_count; ++r) {
      if (((is_new >> r) & 1u) != 0) {
        if (!read_vertex(own_, named_.stored++, out_.position[r])) return false;
        continue;
      }
      const std::uint32_t place = take(place_bits);
      const std::uint32_t slot = place & slot_mask;
      const std::uint32_t number = place >> slot_bits;
      if (slot > named_.other_count || !read_vertex(places[slot], number, out_.position[r])) {
        return false;
      }
      ClusterLeafFields::Other& other = slot == 0 ? named_.self : named_.others[slot - 1];
      other.named = std::max(other.named, number + 1);
    }
    named_.self.leaf = self_;
    named_.begin = own_.middle - std::uint64_t{named_.stored} * own_.stride;
    return true;
  }

  bool read_vertex(const ClusterLeafPlace& leaf, std::uint32_t number,
                   std::array<double, 3>& out) const {
    const std::uint64_t back = std::uint64_t{number + 1} * leaf.stride;
    if (back > leaf.middle) return false;
    std::uint64_t at = leaf.middle - back;
    std::array<std::uint64_t, 3> stored;
    if (leaf.stride <= kMostBitsRead) {
      std::uint64_t fields = read_bits(cluster_.bytes, at, kMostBitsRead);
      for (std::size_t k = 0; k < 3; ++k) {
        stored[k] = fields & ((std::uint64_t{1} << leaf.width[k]) - 1);
        fields >>= leaf.width[k];
      }
    } else {
      for (std::size_t k = 0; k < 3; ++k) {
        stored[k] = read_wide_bits(cluster_.bytes, at, leaf.width[k]);
        at += leaf.width[k];
      }
    }
    // Unsigned, so that corrupt sums wrap.
    for (std::size_t k = 0; k < 3; ++k) stored[k] += leaf.base[k];
    const std::array<std::uint8_t, 3>& trailing = cluster_.header.trailing;
    for (std::size_t k = 0; k < 3; ++k) out[k] = position_of(stored[k], trailing[k]);
    return true;
  }

  [[nodiscard]] double position_of(std::uint64_t number, std::uint32_t trailing) const {
    const auto number_32 = static_cast<std::int32_t>(static_cast<std::uint32_t>(number));
    switch (view_.numbers) {
      case ClusterNumbers::kGrid:
        return static_cast<std::int32_t>(static_cast<std::uint32_t>(number_32) << trailing);
      case ClusterNumbers::kF32:
        return float_of_number(number_32, trailing);
      case ClusterNumbers::kF64:
        break;
    }
    return double_of_number(static_cast<std::int64_t>(number), trailing);
  }

  // References lead to the third corners of all faces, then to the other two of those that are
  // apart, then to the fourth corners of quads.
  void join_faces() {
    auto apart = static_cast<std::uint8_t>(out_.face_count);
    auto fourth = static_cast<std::uint8_t>(out_.vertex_count -
                                            static_cast<std::uint32_t>(std::popcount(quads_)));
    // From the corner at which the edge begins that the face is entered by.
    std::array<std::uint8_t, 3> face{};
    for (std::uint8_t f = 0; f < out_.face_count; ++f) {
      const bool is_apart = step(f) == StripStep::kApart;
      if (is_apart) {
        face = {apart, static_cast<std::uint8_t>(apart + 1), f};
        apart += 2;
      } else {
        const bool is_second_side = step(f) >= StripStep::code(1, 0);
        face = {is_second_side ? face[0] : face[2], is_second_side ? face[2] : face[1], f};
      }
      const std::uint32_t turn = is_apart ? 0 : step(f) % 3;
      for (std::uint32_t i = 0; i < 3; ++i) out_.corner[f][(turn + i) % 3] = face[i];
      out_.corner[f][3] = ((quads_ >> f) & 1u) != 0 ? fourth++ : ClusterLeaf::kNoCorner;
    }
  }

  const ClusterView& view_;
  ClusterLeaf& out_;
  Cluster cluster_;
  ClusterLeafPlace own_;
  std::uint32_t self_ = 0;  // number of the leaf in the cluster
  std::uint64_t at_ = 0;    // bit of the next field
  ClusterLeafFields named_;
  std::uint32_t quads_ = 0;  // bit f: face f has a fourth corner
  std::uint32_t steps_ = 0;
};

}  // namespace

bool decode_cluster_leaf(const ClusterView& clusters, std::uint32_t leaf, ClusterLeaf& out,
                         ClusterLeafFields* fields) noexcept {
  return LeafDecoder(clusters, out).run(leaf, fields);
}

}  // namespace boxtree
