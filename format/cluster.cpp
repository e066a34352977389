// SPDX-License-Identifier: MIT
// Decoding of one leaf of a cluster (encoder: cooker/encode/cluster_geometry.cpp).
#include "format/cluster.h"

#include "format/bits.h"
#include "format/cluster_leaf.h"

namespace boxtree {
namespace {

// Reads the fields of a leaf in order. No read leaves the section: a leaf begins where
// kClusterPadding bytes and more follow, and has at most 8 faces with a bit for a fourth corner, 7
// steps, 32 references of one bit each, the width of those that are old, and 11 bits for each: 416
// bits, after which one word is read. Its vertices lie in groups that find_cluster has checked.
static_assert(kClusterPadding >= 416 / 8 + kBitPadding);

class LeafDecoder {
 public:
  LeafDecoder(const ClusterView& view, FoundCluster& found, ClusterLeaf& out)
      : view_(view), found_(found), cluster_(found.cluster), groups_(found.groups), out_(out) {}

  bool run(std::uint32_t leaf, ClusterLeafFields* fields) {
    if (!find(leaf / kClusterLeaves)) return false;
    ClusterLeafPlace place;
    if (!find_leaf(cluster_, leaf % kClusterLeaves, place)) return false;
    at_ = std::uint64_t{place.byte} * 8;
    out_.face_count = std::min(kLeafFaces, view_.face_count - leaf * kLeafFaces);
    quads_ = view_.corners_per_face == 4 ? take(out_.face_count) : 0;
    steps_ = take(StripStep::kBits * (out_.face_count - 1));
    std::uint32_t count = out_.face_count + 2 + static_cast<std::uint32_t>(std::popcount(quads_));
    for (std::uint32_t f = 1; f < out_.face_count; ++f) {
      if (step(f) > StripStep::kApart) return false;
      count += step(f) == StripStep::kApart ? 2u : 0u;
    }
    out_.vertex_count = count;
    ClusterLeafFields found;
    found.first = place.first;
    if (!read_references(found)) return false;
    join_faces();
    if (fields != nullptr) {
      const auto start = static_cast<std::uint64_t>(cluster_.bytes - view_.bytes.data()) * 8;
      found.begin = start + std::uint64_t{place.byte} * 8;
      found.end = start + at_;
      *fields = found;
    }
    return true;
  }

 private:
  bool find(std::uint32_t number) {
    if (found_.section == view_.bytes.data() && found_.number == number) return true;
    found_.section = nullptr;
    if (!find_cluster(view_, number, found_.cluster) ||
        !find_groups(found_.cluster, found_.groups)) {
      return false;
    }
    found_.section = view_.bytes.data();
    found_.number = number;
    return true;
  }

  // Precondition: width <= kMostBitsRead.
  std::uint32_t take(std::uint32_t width) {
    const std::uint64_t field = read_bits(cluster_.bytes, at_, width);
    at_ += width;
    return static_cast<std::uint32_t>(field);
  }

  [[nodiscard]] std::uint32_t step(std::uint32_t face) const {  // from the face before
    if (face == 0) return StripStep::kApart;
    return (steps_ >> (StripStep::kBits * (face - 1))) & ((1u << StripStep::kBits) - 1);
  }

  // The vertices that references lead to: the next that no leaf before has used, or one that is so
  // many before the last of these.
  bool read_references(ClusterLeafFields& found) {
    std::uint32_t is_new = take(out_.face_count);
    const std::uint32_t wider = take(kOldWiderBits);
    const std::uint32_t old_bits = cluster_.header().old_bits() + wider;
    is_new |= take(out_.vertex_count - out_.face_count) << out_.face_count;
    found.new_vertices = static_cast<std::uint32_t>(std::popcount(is_new));
    found.has_width_of_none = wider != 0 && found.new_vertices == out_.vertex_count;
    const std::uint32_t end = found.first + found.new_vertices;
    std::uint32_t next = found.first;
    for (std::uint32_t r = 0; r < out_.vertex_count; ++r) {
      // Wraps where an old vertex would be before the first of the cluster.
      const std::uint32_t number = ((is_new >> r) & 1u) != 0 ? next++ : end - 1 - take(old_bits);
      if (number >= cluster_.header().vertex_count()) return false;
      read_vertex(number, out_.position[r]);
    }
    return true;
  }

  // Precondition: the cluster has the vertex.
  void read_vertex(std::uint32_t number, std::array<double, 3>& out) const {
    const std::uint32_t group = number / cluster_.header().group_size();
    const std::uint32_t stride = groups_.stride[group];
    std::uint64_t at = std::uint64_t{8} * (cluster_.vertices_at + groups_.start[group]) +
                       (number - group * cluster_.header().group_size()) * stride;
    std::array<std::uint64_t, 3> stored;
    if (stride <= kMostBitsRead) {
      std::uint64_t fields = read_bits(cluster_.bytes, at, kMostBitsRead);
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t width = groups_.width[k][group];
        stored[k] = fields & ((std::uint64_t{1} << width) - 1);
        fields >>= width;
      }
    } else {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t width = groups_.width[k][group];
        stored[k] = read_wide_bits(cluster_.bytes, at, width);
        at += width;
      }
    }
    // Unsigned, so that corrupt sums wrap.
    for (std::size_t k = 0; k < 3; ++k) {
      const auto base = std::to_integer<std::uint64_t>(
          cluster_.bytes[cluster_.bases_at + k * cluster_.groups + group]);
      stored[k] += cluster_.origin(k) + (base << cluster_.header().base_shift(k));
      out[k] = position_of(stored[k], cluster_.header().trailing(k));
    }
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
  FoundCluster& found_;
  const Cluster& cluster_;
  const ClusterGroups& groups_;
  ClusterLeaf& out_;
  std::uint64_t at_ = 0;     // bit of the next field
  std::uint32_t quads_ = 0;  // bit f: face f has a fourth corner
  std::uint32_t steps_ = 0;
};

}  // namespace

bool find_groups(const Cluster& cluster, ClusterGroups& out) noexcept {
  out = {};
  std::uint32_t widest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    auto wider = load<std::uint64_t>(cluster.bytes + cluster.wider_at + k * cluster.wider_bytes());
    for (std::uint32_t g = 0; g < cluster.groups; ++g) {
      const auto width = static_cast<std::uint32_t>(cluster.header().width(k) +
                                                    (wider & low_bits(ClusterHeader::kWiderBits)));
      wider >>= ClusterHeader::kWiderBits;
      widest = std::max(widest, width);
      out.width[k][g] = static_cast<std::uint8_t>(width);
      out.stride[g] = static_cast<std::uint8_t>(out.stride[g] + width);
    }
  }
  std::uint32_t end = 0;
  for (std::uint32_t g = 0; g < cluster.groups; ++g) {
    out.start[g] = static_cast<std::uint16_t>(end);
    const std::uint32_t vertices =
        g + 1 == cluster.groups ? cluster.last_group_size() : cluster.header().group_size();
    end += (vertices * out.stride[g] + 7) / 8;
  }
  return widest <= cluster.number_bits && cluster.vertices_at + end == cluster.header().leaves_at();
}

bool decode_cluster_leaf(const ClusterView& clusters, std::uint32_t leaf, FoundCluster& found,
                         ClusterLeaf& out, ClusterLeafFields* fields) noexcept {
  return LeafDecoder(clusters, found, out).run(leaf, fields);
}

}  // namespace boxtree
