// SPDX-License-Identifier: MIT
// Where the fields of a cluster and of its leaves lie, and what its numbers stand for: what every
// decoder of leaves shares (decoders: format/cluster.cpp, runtime/walk/cluster-inl.h; encoder:
// cooker/encode/cluster_geometry.cpp; format: docs/FORMAT.md 8.1). Always inlined, because walks
// compile it once per instruction set.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "format/bits.h"
#include "format/cluster.h"

#define BOXTREE_ALWAYS_INLINE [[gnu::always_inline]] inline

namespace boxtree {

/// The float that a number stands for. Numbers from 0 on are the bits of floats from 0 on, without
/// `trailing` zero bits at the end; -1 - n is the negative of the float that n is. So numbers are
/// in the order of floats, and -0 is not 0.
[[nodiscard]] constexpr float float_of_number(std::int32_t number,
                                              std::uint32_t trailing) noexcept {
  const auto sign = static_cast<std::uint32_t>(number >> 31);
  const std::uint32_t magnitude = (static_cast<std::uint32_t>(number) ^ sign) << trailing;
  return std::bit_cast<float>(magnitude | (sign & 0x80000000u));
}
[[nodiscard]] constexpr double double_of_number(std::int64_t number,
                                                std::uint32_t trailing) noexcept {
  const auto sign = static_cast<std::uint64_t>(number >> 63);
  const std::uint64_t magnitude = (static_cast<std::uint64_t>(number) ^ sign) << trailing;
  return std::bit_cast<double>(magnitude | (sign & 0x8000000000000000u));
}

/// Where the parts of one cluster lie. Bits and bytes count from its first byte.
struct Cluster {
  const std::byte* bytes = nullptr;
  std::uint64_t size = 0;  // fields may begin at bytes up to this one
  ClusterHeader header;
  std::array<std::uint64_t, 3> origin;  // sign extended
  std::uint32_t table = 0;              // bit of the first entry
  std::uint32_t entry_bits = 0;         // at most 40
  std::uint32_t leaves_at = 0;          // byte that starts of leaves count from
};

/// Where the fields of one leaf of a cluster lie: its vertices end where its faces begin.
struct ClusterLeafPlace {
  std::uint64_t middle = 0;            // bit
  std::array<std::uint64_t, 3> base;   // of its vertices' numbers
  std::array<std::uint32_t, 3> width;  // of their offsets
  std::uint32_t stride = 0;            // bits of one vertex
};

/// Bits of the number of other leaves that a leaf names vertices of.
inline constexpr std::uint32_t kOtherBits = 3;
static_assert(kMaxOtherLeaves < 1u << kOtherBits);

namespace cluster_detail {

// Bits of a word of eight fields of a byte each whose field is above that of `most`. All fields and
// limits are below 128, or the bit of the field is set.
BOXTREE_ALWAYS_INLINE std::uint64_t above(std::uint64_t fields, std::uint64_t most) {
  constexpr std::uint64_t kHighBits = 0x8080808080808080u;
  return (fields | ((fields & ~kHighBits) + (kHighBits - 0x0101010101010101u - most))) & kHighBits;
}

// Whether all shifts and widths are such that no shift of a number is by its own width or more, and
// the fields of an axis in an entry have at most kMostEntryBits.
BOXTREE_ALWAYS_INLINE bool are_valid(const ClusterHeader& header, bool is_64) {
  const auto fields = std::bit_cast<std::array<std::byte, sizeof(ClusterHeader)>>(header);
  const auto first = load<std::uint64_t>(fields.data(), 0);
  const auto second = load<std::uint64_t>(fields.data(), 1);
  // trailing, base_bits, two of base_shift; the third, width, wider_bits, start_bits.
  const std::uint64_t most_first = is_64 ? 0x3f3f0808083f3f3fu : 0x1f1f0808081f1f1fu;
  const std::uint64_t most_second = is_64 ? 0x100808084040403fu : 0x100808082020201fu;
  constexpr std::uint64_t kThree = 0xffffffu;
  const std::uint64_t entry = ((first >> 24) & kThree) + ((second >> 32) & kThree);
  bool fits =
      (above(first, most_first) | above(second, most_second) | above(entry, 0x080808u)) == 0 &&
      header.own_bits <= ClusterHeader::kMostOwnBits;
  for (std::size_t k = 0; k < 3; ++k) {
    fits &= header.width[k] + low_bits(header.wider_bits[k] & 0xfu) <= (is_64 ? 64u : 32u);
  }
  return fits;
}

}  // namespace cluster_detail

/// Finds cluster `number`. False if it is corrupt. Precondition: it has an offset.
BOXTREE_ALWAYS_INLINE bool find_cluster(const ClusterView& view, std::uint32_t number,
                                        Cluster& out) noexcept {
  const bool is_64 = view.numbers == ClusterNumbers::kF64;
  const std::uint32_t origin_bytes = 3 * (is_64 ? sizeof(std::int64_t) : sizeof(std::int32_t));
  const std::uint64_t start = load<std::uint32_t>(view.offsets, number) * kClusterUnit;
  const std::uint64_t fixed = sizeof(ClusterHeader) + origin_bytes;
  if (!in_range(start, fixed + kClusterPadding, view.bytes.size())) return false;
  out.bytes = view.bytes.data() + start;
  out.size = view.bytes.size() - start - kClusterPadding;
  out.header = load<ClusterHeader>(out.bytes);
  const ClusterHeader& header = out.header;
  const std::byte* const origin = out.bytes + sizeof(ClusterHeader);
  for (std::size_t k = 0; k < 3; ++k) {
    out.origin[k] = static_cast<std::uint64_t>(is_64 ? load<std::int64_t>(origin, k)
                                                     : load<std::int32_t>(origin, k));
  }
  const std::uint32_t faces = std::min(view.face_count - number * kClusterFaces, kClusterFaces);
  const auto leaves = static_cast<std::uint32_t>(leaves_of(faces));
  out.table = static_cast<std::uint32_t>(fixed) * 8;
  out.entry_bits = header.start_bits;
  for (std::size_t k = 0; k < 3; ++k) {
    out.entry_bits += std::uint32_t{header.base_bits[k]} + header.wider_bits[k];
  }
  out.leaves_at = static_cast<std::uint32_t>(fixed) + (leaves * out.entry_bits + 7) / 8;
  return cluster_detail::are_valid(header, is_64) && out.leaves_at <= out.size;
}

/// Finds leaf `leaf` of a cluster. False if its place is corrupt. Precondition: the cluster has it.
BOXTREE_ALWAYS_INLINE bool find_leaf(const Cluster& cluster, std::uint32_t leaf,
                                     ClusterLeafPlace& out) noexcept {
  const ClusterHeader& header = cluster.header;
  std::uint64_t entry =
      read_bits(cluster.bytes, cluster.table + leaf * cluster.entry_bits, cluster.entry_bits);
  const std::uint64_t start = entry & low_bits(header.start_bits);
  entry >>= header.start_bits;
  out.stride = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint64_t base = entry & low_bits(header.base_bits[k]);
    entry >>= header.base_bits[k];
    const auto wider = static_cast<std::uint32_t>(entry & low_bits(header.wider_bits[k]));
    entry >>= header.wider_bits[k];
    out.base[k] = cluster.origin[k] + (base << header.base_shift[k]);
    out.width[k] = header.width[k] + wider;
    out.stride += out.width[k];
  }
  const std::uint64_t middle = cluster.leaves_at + leaf * header.leaf_bytes + start;
  out.middle = middle * 8;
  return middle <= cluster.size;
}

}  // namespace boxtree

#undef BOXTREE_ALWAYS_INLINE
