// SPDX-License-Identifier: MIT
// What has to be zero in each codec and in the clusters of the grid.
#include <algorithm>
#include <string>

#include <boxtree/cooker/proof/reserved.h>
#include <boxtree/format/bits.h>
#include <boxtree/format/codec_packed.h>
#include <boxtree/format/codec_plain.h>
#include <boxtree/format/codec_wide.h>
#include <boxtree/format/grid_leaf.h>

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
    end = places.array_at[kind] * 8 + std::uint64_t{header.node_count[kind]} * layout.bits;
  }
  check.expect(are_zero(nodes, end, std::uint64_t{nodes.size()} * 8), "array ", kNodeKinds - 1,
               "the bits behind it");
}

// Precondition: the sections have been bound. Clusters whose leaves cannot be found are for the
// walk to report.
void check_grid(const GridView& grid, Check& check) {
  const std::uint32_t clusters = clusters_of(grid.face_count);
  std::uint64_t end = 0;  // of the cluster before, in bits
  for (std::uint32_t n = 0; n < clusters; ++n) {
    const auto cluster = load<ClusterRecord>(grid.clusters, n);
    check.expect(cluster.reserved == 0, "cluster ", n, "its last byte");
    std::uint32_t vertices = 0;
    GridOffsets offsets;
    std::uint64_t leaf = 0;
    if (!grid_detail::find_grid_leaf(grid, n * kClusterLeaves, vertices, offsets, leaf)) return;
    const std::uint64_t start = cluster.offset * kClusterUnit * 8;
    check.expect(start >= end && start - end < kClusterUnit * 8 && are_zero(grid.bytes, end, start),
                 "cluster ", n, "the bits between it and the one before");
    end = offsets.start + std::uint64_t{vertices} * offsets.stride;
  }
  const std::uint64_t size = std::uint64_t{grid.bytes.size()} * 8;
  check.expect(end <= size && are_zero(grid.bytes, end, size), "clusters before ", clusters,
               "the bits behind them");
}

}  // namespace

Findings check_reserved(const TreeRecord& record, Bytes nodes, Bytes vertices, Bytes corners) {
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
  if (record.geometry == GeometryId::kGrid) {
    check_grid({corners.data(), vertices, record.face_count, record.corners_per_face}, check);
  }
  return findings;
}

}  // namespace boxtree::cooker
