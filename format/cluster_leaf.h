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

/// Byte i of word n: how many of bits 0 to i of n are set.
inline constexpr std::array<std::uint64_t, 256> kRanksOfBits = [] {
  std::array<std::uint64_t, 256> words{};
  for (std::size_t bits = 0; bits < words.size(); ++bits) {
    for (std::uint32_t i = 0; i < 8; ++i) {
      words[bits] |= std::uint64_t(std::popcount(bits & low_bits(i + 1))) << (8 * i);
    }
  }
  return words;
}();

namespace cluster_detail {

// Bits of a word of eight fields of a byte each whose field is above that of `most`. All fields and
// limits are below 128, or the bit of the field is set.
BOXTREE_ALWAYS_INLINE std::uint64_t above(std::uint64_t fields, std::uint64_t most) {
  constexpr std::uint64_t kHighBits = 0x8080808080808080u;
  return (fields | ((fields & ~kHighBits) + (kHighBits - 0x0101010101010101u - most))) & kHighBits;
}

// The fields of a header that are checked and added up, a byte each.
struct HeaderBytes {
  std::uint64_t first;   // trailing, base_bits, two of base_shift
  std::uint64_t second;  // the third, width, wider_bits, start_bits
  static constexpr std::uint64_t kAxes = 0xffffffu;

  [[nodiscard]] BOXTREE_ALWAYS_INLINE std::uint64_t base_bits() const {
    return (first >> 24) & kAxes;
  }
  [[nodiscard]] BOXTREE_ALWAYS_INLINE std::uint64_t width() const { return (second >> 8) & kAxes; }
  [[nodiscard]] BOXTREE_ALWAYS_INLINE std::uint64_t wider_bits() const {
    return (second >> 32) & kAxes;
  }
  // Bits of an entry. Precondition: those of an axis are below 86.
  [[nodiscard]] BOXTREE_ALWAYS_INLINE std::uint32_t entry_bits() const {
    const std::uint64_t of_axes = (base_bits() + wider_bits()) * 0x010101u;
    return static_cast<std::uint32_t>(((of_axes >> 16) & 0xffu) + (second >> 56));
  }

  // Whether all shifts and widths are such that no shift of a number is by its own width or more,
  // and the fields of an axis in an entry have at most kMostEntryBits.
  [[nodiscard]] BOXTREE_ALWAYS_INLINE bool are_valid(bool is_64) const {
    const std::uint64_t most_first = is_64 ? 0x3f3f0808083f3f3fu : 0x1f1f0808081f1f1fu;
    // A width of 2^6 - 1 bits more fits into 64 bits, but one of 2^7 - 1 does not.
    const std::uint64_t most_second = is_64 ? 0x100606064040403fu : 0x100505052020201fu;
    const std::uint64_t of_wider = wider_bits();
    const std::uint64_t widest_more = (std::uint64_t{1} << (of_wider & 0x3fu)) +
                                      (std::uint64_t{0x100} << ((of_wider >> 8) & 0x1fu)) +
                                      (std::uint64_t{0x10000} << ((of_wider >> 16) & 0x1fu)) -
                                      0x010101u;
    const std::uint64_t widest = (width() + widest_more) & kAxes;
    return (above(first, most_first) | above(second, most_second) |
            above(base_bits() + of_wider, 0x080808u) |
            above(widest, is_64 ? 0x404040u : 0x202020u)) == 0;
  }
};

}  // namespace cluster_detail

/// Finds cluster `number`. False if it is corrupt. Precondition: it exists, and so does the
/// table.
BOXTREE_ALWAYS_INLINE bool find_cluster(const ClusterView& view, std::uint32_t number,
                                        Cluster& out) noexcept {
  const bool is_64 = view.numbers == ClusterNumbers::kF64;
  const std::uint32_t fixed =
      sizeof(ClusterHeader) + 3 * (is_64 ? sizeof(std::int64_t) : sizeof(std::int32_t));
  const std::uint64_t start = load<std::uint32_t>(view.bytes.data(), number) * kClusterUnit;
  if (!in_range(start, fixed + kClusterPadding, view.bytes.size())) return false;
  out.bytes = view.bytes.data() + start;
  out.size = view.bytes.size() - start - kClusterPadding;
  out.header = load<ClusterHeader>(out.bytes);
  const cluster_detail::HeaderBytes fields{load<std::uint64_t>(out.bytes, 0),
                                           load<std::uint64_t>(out.bytes, 1)};
  const std::byte* const origin = out.bytes + sizeof(ClusterHeader);
  if (is_64) {
    out.origin = load<std::array<std::uint64_t, 3>>(origin);
  } else {
    const auto of_32 = load<std::array<std::int32_t, 3>>(origin);
    out.origin = {static_cast<std::uint64_t>(of_32[0]), static_cast<std::uint64_t>(of_32[1]),
                  static_cast<std::uint64_t>(of_32[2])};
  }
  const std::uint32_t faces = std::min(view.face_count - number * kClusterFaces, kClusterFaces);
  const auto leaves = static_cast<std::uint32_t>(leaves_of(faces));
  out.table = fixed * 8;
  out.entry_bits = fields.entry_bits();
  out.leaves_at = fixed + (leaves * out.entry_bits + 7) / 8;
  return fields.are_valid(is_64) && out.header.own_bits <= ClusterHeader::kMostOwnBits &&
         out.leaves_at <= out.size;
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
