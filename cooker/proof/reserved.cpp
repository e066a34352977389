// SPDX-License-Identifier: MIT
// Checks the reserved bits of each codec, of clusters and of face ids.
#include "cooker/proof/reserved.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "format/active_edges.h"
#include "format/bits.h"
#include "format/cluster_leaf.h"
#include "format/codec_packed.h"
#include "format/codec_plain.h"
#include "format/codec_wide.h"
#include "format/face_ids.h"
#include "format/limits.h"
#include "format/tree_record.h"
#include "runtime/file/open_file.h"

namespace boxtree::cooker {
namespace {

class Check {
 public:
  explicit Check(Findings& findings) : findings_(findings) {}

  void expect(bool holds, const char* what, std::uint64_t number, const char* where) {
    if (holds || findings_.size() >= kMaxFindings) return;
    findings_.push_back(
        {Errc::kPaddingNotZero, what + std::to_string(number) + ": " + where + " are not zero"});
  }

  void misplaced_ids(std::uint32_t group, std::uint32_t block) {
    if (findings_.size() >= kMaxFindings) return;
    findings_.push_back({Errc::kFaceOutOfRange, "face ids: block " + std::to_string(block) +
                                                    " of group " + std::to_string(group) +
                                                    " is not where the one before ends"});
  }

  void large_id(std::uint32_t face, std::uint32_t id) {
    if (findings_.size() >= kMaxFindings) return;
    findings_.push_back({Errc::kFaceOutOfRange, "face " + std::to_string(face) + " has the id " +
                                                    std::to_string(id) + ", limit " +
                                                    std::to_string(kMaxFaces - 1)});
  }

  void edges(bool holds, const std::string& fault) {
    if (holds || findings_.size() >= kMaxFindings) return;
    findings_.push_back({Errc::kRecordInvalid, "active edges: " + fault});
  }

  void misplaced_vertex(std::uint32_t leaf, std::uint32_t first, std::uint32_t expected) {
    if (findings_.size() >= kMaxFindings) return;
    findings_.push_back(
        {Errc::kVertexOutOfRange, "leaf " + std::to_string(leaf) + " says that vertex " +
                                      std::to_string(first) +
                                      " of its cluster is the first that it uses first, expected " +
                                      std::to_string(expected)});
  }

  void unused_vertices(std::uint32_t cluster, std::uint32_t count, std::uint32_t used) {
    if (findings_.size() >= kMaxFindings) return;
    findings_.push_back({Errc::kVertexOutOfRange,
                         "cluster " + std::to_string(cluster) + " has " + std::to_string(count) +
                             " vertices, of which its leaves use " + std::to_string(used)});
  }

 private:
  Findings& findings_;
};

// Whether bits [first, last) are zero. Precondition: they are inside.
bool are_zero(Bytes bytes, std::uint64_t first, std::uint64_t last) {
  for (; first < last && first % 8 != 0; ++first) {
    if ((std::to_integer<unsigned>(bytes[first / 8]) >> (first % 8) & 1u) != 0) return false;
  }
  for (; first + 8 <= last; first += 8) {
    if (bytes[first / 8] != std::byte{0}) return false;
  }
  return first >= last || (std::to_integer<unsigned>(bytes[first / 8]) &
                           low_bits(static_cast<unsigned>(last - first))) == 0;
}

template <class Node>
void check_wide(Bytes nodes, Check& check) {
  for (std::size_t n = 0; n < nodes.size() / sizeof(Node); ++n) {
    const auto node = load<Node>(nodes.data(), n);
    const std::uint32_t count = links_of(node).child_count;
    bool unused = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t child = count; child < kWideChildren; ++child) {
        unused |= (node.low_code(axis, child) | node.high_code(axis, child)) != 0;
      }
    }
    check.expect(!unused, "node ", n, "codes of children that are not there");
    if constexpr (std::is_same_v<Node, Wide8Node>) {
      check.expect(node.reserved == decltype(node.reserved){}, "node ", n, "its last bytes");
    }
  }
}

template <class Node>
void check_plain(Bytes nodes, Check& check) {
  for (std::size_t n = 0; n < nodes.size() / sizeof(Node); ++n) {
    const auto node = load<Node>(nodes.data(), n);
    check.expect((node.cutplane >> 6) == 0, "node ", n, "upper bits of its cutplane");
    for (std::size_t side = 0; side < 2; ++side) {
      const bool is_there = node.kind(side) != PlainChild::kNone;
      check.expect(is_there || (node.child[side] == kPlainNoChild && node.cut[side] == 0), "node ",
                   n, "the cut and the inverse of the number of a child that is not there");
    }
  }
}

// Whether a missing child is stored with kind 0 and cut 0. Precondition: `node` is the bit at which
// a node of that layout starts, and the section has been bound.
bool is_written_as_missing(Bytes nodes, const PackedHeader& header, const PackedLayout& layout,
                           std::uint64_t node, std::size_t side) {
  const std::byte* const bytes = nodes.data();
  const std::uint64_t cut = read_wide_bits(bytes, node + layout.cut_at[side], header.cut_bits);
  const std::byte* const table = bytes + sizeof(PackedHeader);
  const bool is_zero = header.cut_count == 0
                           ? cut == 0
                           : cut < header.cut_count && load<std::uint32_t>(table, cut) == 0;
  return is_zero && read_bits(bytes, node + layout.kind_at[side], 2) == 0;
}

void check_packed_children(Bytes nodes, const PackedHeader& header, NodeKind kind,
                           std::uint64_t array, Check& check) {
  const PackedLayout layout(kind, header);
  for (std::uint32_t n = 0; n < header.node_count[static_cast<std::size_t>(kind)]; ++n) {
    const std::uint64_t node = array + std::uint64_t{n} * layout.bits;
    for (std::size_t side = 0; side < 2; ++side) {
      const std::uint32_t width = layout.number_bits[side];
      const bool is_missing =
          !is_leaf_side(kind, side) &&
          read_bits(nodes.data(), node + layout.number_at[side], width) == low_bits(width);
      check.expect(!is_missing || is_written_as_missing(nodes, header, layout, node, side), "node ",
                   n, "kind and cut of a child that is not there");
    }
  }
}

// Precondition: the section has been bound.
void check_packed(Bytes nodes, Check& check) {
  const auto header = load<PackedHeader>(nodes.data());
  const PackedPlaces places(header);
  std::uint64_t end = sizeof(PackedHeader) + std::uint64_t{header.cut_count} * sizeof(float);
  end *= 8;
  for (std::size_t kind = 0; kind < kNodeKinds; ++kind) {
    check.expect(are_zero(nodes, end, places.array_at[kind] * 8), "array ", kind,
                 "the bits before it");
    const PackedLayout layout(static_cast<NodeKind>(kind), header);
    check_packed_children(nodes, header, static_cast<NodeKind>(kind), places.array_at[kind] * 8,
                          check);
    end = places.array_at[kind] * 8 + std::uint64_t{header.node_count[kind]} * layout.bits;
  }
  check.expect(are_zero(nodes, end, std::uint64_t{nodes.size()} * 8), "array ", kNodeKinds - 1,
               "the bits behind it");
}

// Checks the bits between the groups of a cluster. `start`: the bit where it begins.
void check_groups(const ClusterView& clusters, const Cluster& cluster, const ClusterGroups& groups,
                  std::uint32_t n, std::uint64_t start, Check& check) {
  const std::uint32_t wider_bits = ClusterHeader::kWiderBits * cluster.groups;
  std::uint64_t at = start + std::uint64_t{8} * cluster.wider_at;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint64_t next = at + std::uint64_t{8} * cluster.wider_bytes();
    check.expect(are_zero(clusters.bytes, at + wider_bits, next), "cluster ", n,
                 "the bits after the widths of its groups");
    at = next;
  }
  for (std::uint32_t g = 0; g < cluster.groups; ++g) {
    const std::uint32_t vertices =
        g + 1 == cluster.groups ? cluster.last_group_size() : cluster.header().group_size();
    const std::uint64_t end = start + std::uint64_t{8} * (cluster.vertices_at + groups.start[g]) +
                              vertices * groups.stride[g];
    check.expect(are_zero(clusters.bytes, end, align_up(end, 8)), "cluster ", n,
                 "the bits after the vertices of a group");
  }
}

// Checks the bits between the fields of cluster n, and that its leaves use its vertices in order.
// False if it or a leaf cannot be read. `end`: the bit after the last cluster, and on return after
// this one.
bool check_cluster(const ClusterView& clusters, std::uint32_t n, std::uint64_t& end, Check& check) {
  Cluster cluster;
  ClusterGroups groups;
  if (!find_cluster(clusters, n, cluster) || !find_groups(cluster, groups)) return false;
  const std::uint64_t start = static_cast<std::uint64_t>(cluster.bytes - clusters.bytes.data()) * 8;
  check.expect(
      start >= end && start - end < kClusterUnit * 8 && are_zero(clusters.bytes, end, start),
      "cluster ", n, "the bits between it and the one before");
  check_groups(clusters, cluster, groups, n, start, check);
  const auto leaves = static_cast<std::uint32_t>(leaves_of(clusters.face_count));
  const std::uint32_t first = n * kClusterLeaves;
  const std::uint32_t last = std::min(leaves, first + kClusterLeaves);
  const std::uint64_t table_end =
      start + cluster.table + std::uint64_t{last - first} * cluster.entry_bits;
  check.expect(are_zero(clusters.bytes, table_end, align_up(table_end, 8)), "cluster ", n,
               "the bits after its table");
  end = start + std::uint64_t{cluster.header().leaves_at()} * 8;
  std::uint32_t used = 0;  // vertices
  FoundCluster found;
  for (std::uint32_t i = first; i < last; ++i) {
    ClusterLeaf leaf;
    ClusterLeafFields fields;
    if (!decode_cluster_leaf(clusters, i, found, leaf, &fields)) return false;
    check.expect(fields.begin >= end && are_zero(clusters.bytes, end, fields.begin), "leaf ", i,
                 "the bits before it");
    check.expect(!fields.has_width_of_none, "leaf ", i,
                 "the bits of the width of its old references, of which it has none,");
    if (fields.first != used) check.misplaced_vertex(i, fields.first, used);
    used = fields.first + fields.new_vertices;
    end = std::max(end, fields.end);
  }
  if (used != cluster.header().vertex_count()) {
    check.unused_vertices(n, cluster.header().vertex_count(), used);
  }
  return true;
}

// Precondition: the sections have been bound. Skips what cannot be found; the walk reports it.
void check_clusters(const ClusterView& clusters, Check& check) {
  const std::uint32_t count = clusters_of(clusters.face_count);
  std::uint64_t end = cluster_table_bytes(clusters.face_count) * 8;  // of the previous cluster
  for (std::uint32_t n = 0; n < count; ++n) {
    if (!check_cluster(clusters, n, end, check)) return;
  }
  if (count == 0) return;
  const std::uint64_t size = std::uint64_t{clusters.bytes.size()} * 8;
  const std::uint64_t padding = align_up(end, kClusterUnit * 8) + kClusterPadding * 8;
  check.expect(size == padding && are_zero(clusters.bytes, end, size), "clusters before ", count,
               "the bits behind them, or their number,");
}

// Checks the bits between the blocks of face ids, and that each id has an interval and is a number
// that a face can have. Precondition: the section has been bound.
void check_face_ids(Bytes section, std::uint32_t face_count, Check& check) {
  const FaceIdView ids(section);
  const std::uint32_t groups = id_groups_of(face_count);
  const std::uint64_t last = (section.size() - kBitPadding) * 8;
  std::uint64_t end = id_table_bytes(face_count) * 8;  // of the previous block
  for (std::uint32_t g = 0; g < groups; ++g) {
    const std::uint32_t blocks =
        std::min(kIdGroupBlocks, id_blocks_of(face_count) - g * kIdGroupBlocks);
    FaceIdGroup group{};
    std::memcpy(&group, section.data() + g * sizeof(group),
                offsetof(FaceIdGroup, block) + blocks * sizeof(std::uint32_t));
    const std::uint64_t begin = group.begin * (kIdUnit * 8);
    if (begin != align_up(end, kIdUnit * 8) || begin > last) return check.misplaced_ids(g, 0);
    check.expect(are_zero(section, end, begin), "group ", g, "the bits before its face ids");
    end = begin;
    for (std::uint32_t b = 0; b < blocks; ++b) {
      const std::uint32_t first = g * kIdGroupFaces + b * kIdBlockFaces;
      const FaceIdBlock block = FaceIdBlock::of(group.block[b]);
      const std::uint32_t count = std::min(kIdBlockFaces, face_count - first);
      const std::uint64_t middle = begin + block.middle;
      const std::uint64_t after = middle + std::uint64_t{count} * block.width();
      if (middle < end || after > last || block.grain > FaceIdBlock::kNoGrain) {
        return check.misplaced_ids(g, b);
      }
      std::uint64_t intervals = 0;
      for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint64_t field =
            read_bits(section.data(), middle + std::uint64_t{i} * block.width(), block.width());
        intervals = std::max(intervals, (field >> block.offset_bits) + 1);
        if (ids[first + i] >= kMaxFaces) check.large_id(first + i, ids[first + i]);
      }
      if (middle - end != intervals * block.start_bits) return check.misplaced_ids(g, b);
      end = after;
    }
  }
  check.expect(section.size() * 8 == align_up(end, kIdUnit * 8) + kBitPadding * 8 &&
                   are_zero(section, end, section.size() * 8),
               "group ", groups, "the bits before it, or their number,");
}

// Precondition: the section has been bound.
void check_active_edges(Bytes section, std::uint32_t face_count, Check& check) {
  const auto header = load<ActiveEdgesHeader>(section.data());
  check.edges(header.degrees >= 0 && header.degrees <= 90,
              "the angle is " + std::to_string(header.degrees) + " degrees, expected 0 to 90");
  check.edges(header.is_by_face <= 1,
              "is_by_face is " + std::to_string(header.is_by_face) + ", expected 0 or 1");
  constexpr std::uint64_t kCodes = sizeof(ActiveEdgesHeader) * 8;
  const std::uint32_t leaves = face_count / kLeafFaces + (face_count % kLeafFaces != 0 ? 1 : 0);
  bool has_mixed = false;
  for (std::uint32_t leaf = 0; leaf < leaves; ++leaf) {
    const std::uint64_t at = kCodes + std::uint64_t{leaf} * kLeafEdgesBits;
    const std::uint32_t code = std::to_integer<std::uint32_t>(section[at / 8]) >> (at % 8) & 3u;
    check.edges(
        code <= static_cast<std::uint32_t>(LeafEdges::kMixed),
        "leaf " + std::to_string(leaf) + " has code " + std::to_string(code) + ", expected 0 to 2");
    has_mixed |= code == static_cast<std::uint32_t>(LeafEdges::kMixed);
  }
  check.edges(has_mixed == (header.start_count != 0),
              has_mixed ? "leaves have code 2, but edges no bits"
                        : "edges have bits, but no leaf has code 2");
  const std::uint64_t bits = (sizeof(ActiveEdgesHeader) + leaf_edges_bytes(face_count)) * 8;
  const std::uint64_t used = header.start_count == 0 ? 0 : header.start_count + (kEdgeBits - 1ull);
  const bool are_zeros = are_zero(section, offsetof(ActiveEdgesHeader, zero) * 8, kCodes) &&
                         are_zero(section, kCodes + std::uint64_t{leaves} * kLeafEdgesBits, bits) &&
                         are_zero(section, bits + used, std::uint64_t{section.size()} * 8);
  check.expect(are_zeros, "active edges of faces 0 to ", face_count - 1,
               "the bits that no leaf and no edge has");
}

}  // namespace

Findings check_reserved(const File& opened, std::uint32_t index) {
  const OpenFile& file = OpenFile::of(opened);
  const TreeRecord record = file.tree_record(index);
  const Bytes nodes = file.section(SectionKind::kNodes, index);
  Findings findings;
  Check check(findings);
  if (record.root == RootKind::kSubtree) {
    switch (record.codec) {
      case CodecId::kPlainF32:
        check_plain<PlainNodeF32>(nodes, check);
        break;
      case CodecId::kPlainF16:
        check_plain<PlainNodeF16>(nodes, check);
        break;
      case CodecId::kWide8:
        check_wide<Wide8Node>(nodes, check);
        break;
      case CodecId::kWide4:
        check_wide<Wide4Node>(nodes, check);
        break;
      case CodecId::kPackedF32:
      case CodecId::kPackedF16:
      case CodecId::kPackedF64:
      case CodecId::kDedup:
        check_packed(nodes, check);
        break;
    }
  }
  if (has_clusters(record.geometry)) {
    const bool is_f64 = (record.flags & kTreePositionsF64) != 0;
    check_clusters({file.section(SectionKind::kVertices, index), record.face_count,
                    record.corners_per_face, numbers_of(record.geometry, is_f64)},
                   check);
  }
  const Bytes face_ids = file.section(SectionKind::kFaceIds, index);
  if (!face_ids.empty()) check_face_ids(face_ids, record.face_count, check);
  const Bytes active_edges = file.section(SectionKind::kActiveEdges, index);
  if (!active_edges.empty()) check_active_edges(active_edges, record.face_count, check);
  return findings;
}

}  // namespace boxtree::cooker
