// SPDX-License-Identifier: MIT
// Decoding of one leaf of a cluster (encoder: cooker/encode/cluster_geometry.cpp).
#include "format/cluster.h"

#include "format/bits.h"
#include "format/cluster_leaf.h"

namespace boxtree {
namespace {

// Reads the fields of a leaf in order. No read leaves the section: a leaf begins where
// kClusterPadding bytes and more follow, and has at most 8 faces with a bit for a fourth corner, 7
// steps, 32 references of two bits each, 7 other leaves of 6 bits after their number, and 8 bits
// for each vertex of theirs: 394 bits. References to vertices that were named before have 5 bits,
// but are then the fewer vertices.
static_assert(kClusterPadding >= 394 / 8 + 1 + kBitPadding);

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
    return read_references() && read_vertices() && read_faces(fields);
  }

 private:
  // Precondition: width <= 57.
  std::uint32_t take(std::uint32_t width) {
    const std::uint64_t field = read_bits(cluster_.bytes, at_, width);
    at_ += width;
    return static_cast<std::uint32_t>(field);
  }

  [[nodiscard]] std::uint32_t step(std::uint32_t face) const {  // from the face before
    return (steps_ >> (StripStep::kBits * (face - 1))) & ((1u << StripStep::kBits) - 1);
  }

  // Which references are the first to a vertex in the leaf, and where the others lead.
  bool read_references() {
    std::uint32_t count = 3 + static_cast<std::uint32_t>(std::popcount(quads_));
    for (std::uint32_t f = 1; f < out_.face_count; ++f) {
      if (step(f) > StripStep::kApart) return false;
      count += step(f) == StripStep::kApart ? 3u : 1u;
    }
    const std::uint32_t firsts = (take(count - 1) << 1) | 1u;
    out_.vertex_count = static_cast<std::uint32_t>(std::popcount(firsts));
    own_vertices_ = take(out_.vertex_count);
    const std::uint32_t width = width_below(out_.vertex_count);
    std::uint8_t next = 0;
    for (std::uint32_t r = 0; r < count; ++r) {
      reference_[r] = ((firsts >> r) & 1u) != 0 ? next++ : static_cast<std::uint8_t>(take(width));
      if (reference_[r] >= out_.vertex_count) return false;
    }
    return true;
  }

  bool read_vertices() {
    const auto stored = static_cast<std::uint32_t>(std::popcount(own_vertices_));
    std::array<ClusterLeafPlace, kMaxOtherLeaves> others;
    const std::uint32_t other_count = stored < out_.vertex_count ? take(kOtherBits) : 0;
    for (std::uint32_t i = 0; i < other_count; ++i) {
      const std::uint32_t leaf = take(width_below(self_));
      if (leaf >= self_ || !find_leaf(cluster_, leaf, others[i])) return false;
      named_.others[i].leaf = leaf;
    }
    std::uint32_t next_own = 0;
    for (std::uint32_t v = 0; v < out_.vertex_count; ++v) {
      if (((own_vertices_ >> v) & 1u) != 0) {
        if (!read_vertex(own_, next_own++, out_.position[v])) return false;
        continue;
      }
      const std::uint32_t other = take(width_below(other_count));
      const std::uint32_t number = take(cluster_.header.own_bits);
      if (other >= other_count || !read_vertex(others[other], number, out_.position[v])) {
        return false;
      }
      named_.others[other].largest = std::max(named_.others[other].largest, number);
    }
    named_.stored = stored;
    named_.other_count = other_count;
    named_.begin = own_.middle - std::uint64_t{next_own} * own_.stride;
    return true;
  }

  bool read_vertex(const ClusterLeafPlace& leaf, std::uint32_t number,
                   std::array<double, 3>& out) const {
    const std::uint64_t back = std::uint64_t{number + 1} * leaf.stride;
    if (back > leaf.middle) return false;
    std::uint64_t at = leaf.middle - back;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t offset = read_wide_bits(cluster_.bytes, at, leaf.width[k]);
      // Unsigned, so that corrupt sums wrap.
      out[k] = position_of(leaf.base[k] + offset, cluster_.header.trailing[k]);
      at += leaf.width[k];
    }
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

  bool read_faces(ClusterLeafFields* fields) {
    std::uint32_t r = 0;
    // From the corner at which the edge begins that the face is entered by.
    std::array<std::uint8_t, 3> face{};
    for (std::uint32_t f = 0; f < out_.face_count; ++f) {
      const std::uint32_t code = f == 0 ? StripStep::kApart : step(f);
      const bool is_apart = code == StripStep::kApart;
      if (is_apart) {
        face = {reference_[r], reference_[r + 1], reference_[r + 2]};
        r += 3;
      } else {
        const bool is_second_side = code >= StripStep::code(1, 0);
        face = {is_second_side ? face[0] : face[2], is_second_side ? face[2] : face[1],
                reference_[r++]};
      }
      const std::uint32_t turn = is_apart ? 0 : code % 3;
      for (std::uint32_t i = 0; i < 3; ++i) out_.corner[f][(turn + i) % 3] = face[i];
      out_.corner[f][3] = ((quads_ >> f) & 1u) != 0 ? reference_[r++] : ClusterLeaf::kNoCorner;
    }
    if (fields != nullptr) {
      const auto start = static_cast<std::uint64_t>(cluster_.bytes - view_.bytes.data()) * 8;
      *fields = named_;
      fields->begin += start;
      fields->end = start + at_;
    }
    return true;
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
  std::uint32_t own_vertices_ = 0;  // bit v: vertex v is stored with this leaf
  std::array<std::uint8_t, kMaxLeafVertices> reference_{};
};

}  // namespace

bool decode_cluster_leaf(const ClusterView& clusters, std::uint32_t leaf, ClusterLeaf& out,
                         ClusterLeafFields* fields) noexcept {
  return LeafDecoder(clusters, out).run(leaf, fields);
}

}  // namespace boxtree
