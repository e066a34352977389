// SPDX-License-Identifier: MIT
// The groups of a cluster's vertices by vectors, a lane each.
#if defined(BOXTREE_RUNTIME_WALK_CLUSTER_GROUPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXTREE_RUNTIME_WALK_CLUSTER_GROUPS_INL_H
#undef BOXTREE_RUNTIME_WALK_CLUSTER_GROUPS_INL_H
#else
#define BOXTREE_RUNTIME_WALK_CLUSTER_GROUPS_INL_H
#endif

#include "runtime/tree/leaf_fields.h"
#include "runtime/walk/word_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
#if BOXTREE_HAS_EIGHT_LANES

using GroupBytes = hn::FixedTag<std::uint8_t, ClusterHeader::kMostGroups>;
using GroupByteVector = hn::Vec<GroupBytes>;

/// Those that the cluster does not have have no bits.
struct GroupLanes {
  GroupByteVector width[3];  // of offsets
  GroupByteVector stride;    // bits of a vertex
  hn::Vec<Halves> start;     // byte of the cluster
};

/// How much numbers are above what they may be.
HWY_INLINE GroupByteVector above(GroupByteVector numbers, std::uint8_t most) {
  return hn::SaturatedSub(numbers, hn::Set(GroupBytes(), most));
}
HWY_INLINE bool is_zero(GroupByteVector numbers) {
  return hn::AllTrue(GroupBytes(), hn::Eq(numbers, hn::Zero(GroupBytes())));
}

/// The same as boxtree::find_groups. False if the groups are corrupt.
/// Precondition: they have at most kFastGroupSize vertices.
HWY_INLINE bool find_groups(const Cluster& cluster, GroupLanes& out) {
  const ClusterHeaderView header = cluster.header();
  const GroupBytes bytes;
  const hn::Half<GroupBytes> half;
  const auto is_group = hn::FirstN(bytes, cluster.groups);
  HWY_UNROLL(3)
  for (std::size_t k = 0; k < 3; ++k) {
    const auto* const at = reinterpret_cast<const std::uint8_t*>(cluster.bytes) + cluster.wider_at +
                           k * cluster.wider_bytes();
    const GroupByteVector pairs{hn::LoadU(half, at).raw};
    const hn::Repartition<std::uint16_t, GroupBytes> halves;
    const auto high = hn::BitCast(bytes, hn::ShiftRight<4>(hn::BitCast(halves, pairs)));
    const auto wider = hn::And(hn::InterleaveLower(bytes, pairs, high),
                               hn::Set(bytes, (1 << ClusterHeader::kWiderBits) - 1));
    out.width[k] = hn::IfThenElseZero(is_group, hn::Add(wider, hn::Set(bytes, header.width(k))));
  }
  out.stride = hn::Add(hn::Add(out.width[0], out.width[1]), out.width[2]);
  const auto most = static_cast<std::uint8_t>(cluster.number_bits);
  if (!is_zero(above(hn::Max(hn::Max(out.width[0], out.width[1]), out.width[2]), most))) {
    return false;
  }
  // Where they start: sums of what those before take.
  HWY_ALIGN static constexpr std::uint16_t kIota[ClusterHeader::kMostGroups] = {
      0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  const auto half_words = [](std::uint32_t value) {
    return hn::Set(Halves(), static_cast<std::uint16_t>(value));
  };
  const auto is_last = hn::Eq(hn::Load(Halves(), kIota), half_words(cluster.groups - 1));
  const auto vertices = hn::IfThenElse(is_last, half_words(cluster.last_group_size()),
                                       half_words(header.group_size()));
  const auto taken = hn::ShiftRight<3>(
      hn::Add(hn::Mul(hn::PromoteTo(Halves(), out.stride), vertices), half_words(7)));
  auto end = taken;
  end = hn::Add(end, hn::ShiftLeftLanes<1>(Halves(), end));
  end = hn::Add(end, hn::ShiftLeftLanes<2>(Halves(), end));
  end = hn::Add(end, hn::ShiftLeftLanes<4>(Halves(), end));
  const auto carried = hn::Broadcast<7>(end);
  end = hn::Add(end, hn::ConcatLowerLower(Halves(), carried, hn::Zero(Halves())));
  out.start = hn::Add(hn::Sub(end, taken), half_words(cluster.vertices_at));
  const std::uint32_t all = hn::ExtractLane(hn::UpperHalf(hn::Half<Halves>(), end), 7);
  return cluster.vertices_at + all == header.leaves_at();
}

/// Finds cluster `number` for a reader by vectors. False, and no cluster in `leaves`, if it is
/// corrupt or its groups are too large for products of 16 bits.
HWY_INLINE bool find_cluster(const ClusterView& view, std::uint32_t number, LeafTable& leaves,
                             Cluster& cluster, GroupLanes& groups) {
  leaves.cluster = LeafTable::kNone;
  if (!boxtree::find_cluster(view, number, cluster) ||
      cluster.header().group_size() > ClusterHeader::kFastGroupSize ||
      !find_groups(cluster, groups)) {
    return false;
  }
  leaves.set(number, cluster);
  return true;
}

#endif
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
