// SPDX-License-Identifier: MIT
// Where the fields of a cluster and of its leaves lie, and what its numbers stand for: what every
// decoder of leaves shares (format/cluster.cpp, runtime/tree/plain_cluster.cpp and
// runtime/walk/cluster-inl.h; encoder: cooker/encode/cluster_geometry.cpp; docs/FORMAT.md 8.1).
// Always inlined, because walks compile it once per instruction set.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

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

/// The fields of a header where they lie, at any alignment: each is loaded where it is needed, and
/// nothing is copied.
class ClusterHeaderView {
 public:
  explicit constexpr ClusterHeaderView(const std::byte* bytes) noexcept : bytes_(bytes) {}

  [[nodiscard]] BOXTREE_ALWAYS_INLINE std::uint32_t trailing(std::size_t axis) const noexcept {
    return load<std::uint8_t>(bytes_ + offsetof(ClusterHeader, trailing), axis);
  }
  [[nodiscard]] BOXTREE_ALWAYS_INLINE std::uint32_t base_shift(std::size_t axis) const noexcept {
    return load<std::uint8_t>(bytes_ + offsetof(ClusterHeader, base_shift), axis);
  }
  [[nodiscard]] BOXTREE_ALWAYS_INLINE std::uint32_t width(std::size_t axis) const noexcept {
    return load<std::uint8_t>(bytes_ + offsetof(ClusterHeader, width), axis);
  }
  [[nodiscard]] BOXTREE_ALWAYS_INLINE std::uint32_t group_size() const noexcept {
    return load<std::uint8_t>(bytes_ + offsetof(ClusterHeader, group_size));
  }
  [[nodiscard]] BOXTREE_ALWAYS_INLINE std::uint32_t vertex_count() const noexcept {
    return load<std::uint16_t>(bytes_ + offsetof(ClusterHeader, vertex_count));
  }
  [[nodiscard]] BOXTREE_ALWAYS_INLINE std::uint32_t leaves_at() const noexcept {
    return load<std::uint16_t>(bytes_ + offsetof(ClusterHeader, leaves_at));
  }
  [[nodiscard]] BOXTREE_ALWAYS_INLINE std::uint32_t start_slope() const noexcept {
    return load<std::uint16_t>(bytes_ + offsetof(ClusterHeader, start_slope));
  }
  [[nodiscard]] BOXTREE_ALWAYS_INLINE std::uint32_t start_bias() const noexcept {
    return load<std::uint16_t>(bytes_ + offsetof(ClusterHeader, start_bias));
  }
  [[nodiscard]] BOXTREE_ALWAYS_INLINE std::uint32_t first_bias() const noexcept {
    return load<std::uint16_t>(bytes_ + offsetof(ClusterHeader, first_bias));
  }
  [[nodiscard]] BOXTREE_ALWAYS_INLINE std::uint32_t first_slope() const noexcept {
    return load<std::uint8_t>(bytes_ + offsetof(ClusterHeader, first_slope));
  }
  [[nodiscard]] BOXTREE_ALWAYS_INLINE std::uint32_t start_bits() const noexcept {
    return load<std::uint8_t>(bytes_ + offsetof(ClusterHeader, start_bits));
  }
  [[nodiscard]] BOXTREE_ALWAYS_INLINE std::uint32_t first_bits() const noexcept {
    return load<std::uint8_t>(bytes_ + offsetof(ClusterHeader, first_bits));
  }
  [[nodiscard]] BOXTREE_ALWAYS_INLINE std::uint32_t old_bits() const noexcept {
    return load<std::uint8_t>(bytes_ + offsetof(ClusterHeader, old_bits));
  }

 private:
  const std::byte* bytes_;
};

/// Bits by which a leaf tells how many more than ClusterHeader::old_bits its references have.
inline constexpr std::uint32_t kOldWiderBits = 3;

/// Where the parts of one cluster lie. Bits and bytes count from its first byte.
struct Cluster {
  const std::byte* bytes = nullptr;
  std::uint64_t size = 0;  // fields may begin at bytes up to this one
  std::uint32_t number_bits = 0;
  std::uint32_t groups = 0;
  std::uint32_t table = 0;        // bit of the first entry
  std::uint32_t entry_bits = 0;   // at most 27
  std::uint32_t bases_at = 0;     // byte
  std::uint32_t wider_at = 0;     // byte, see ClusterHeader::kWiderBits
  std::uint32_t vertices_at = 0;  // byte

  [[nodiscard]] BOXTREE_ALWAYS_INLINE ClusterHeaderView header() const noexcept {
    return ClusterHeaderView(bytes);
  }
  /// Sign extended.
  [[nodiscard]] std::uint64_t origin(std::size_t axis) const noexcept {
    const std::byte* const numbers = bytes + sizeof(ClusterHeader);
    if (number_bits == 64) return load<std::uint64_t>(numbers, axis);
    return static_cast<std::uint64_t>(load<std::int32_t>(numbers, axis));
  }
  /// Bytes of the widths of one axis of all groups.
  [[nodiscard]] std::uint32_t wider_bytes() const noexcept { return (groups + 1) / 2; }
  [[nodiscard]] std::uint32_t last_group_size() const noexcept {
    return header().vertex_count() - (groups - 1) * header().group_size();
  }
};

/// The groups of a cluster. Those that it does not have are zero.
struct ClusterGroups {
  template <class T>
  using OfEach = std::array<T, ClusterHeader::kMostGroups>;

  std::array<OfEach<std::uint8_t>, 3> width;  // of offsets
  OfEach<std::uint8_t> stride;                // bits of a vertex
  OfEach<std::uint16_t> start;                // byte after vertices_at
};

/// Where one leaf of a cluster begins, and the number of the first vertex that it uses first.
struct ClusterLeafPlace {
  std::uint32_t byte = 0;
  std::uint32_t first = 0;
};

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

// Bits of a word of eight fields of a byte each whose field is above that of `most`. All limits are
// below 128.
BOXTREE_ALWAYS_INLINE std::uint64_t above(std::uint64_t fields, std::uint64_t most) noexcept {
  constexpr std::uint64_t kHighBits = 0x8080808080808080u;
  return (fields | ((fields & ~kHighBits) + (kHighBits - 0x0101010101010101u - most))) & kHighBits;
}

}  // namespace cluster_detail

/// Whether all fields of a header are in range: no shift of a number of `number_bits` is by as many
/// bits or more, and the groups are neither more than kMostGroups nor larger than they may be.
BOXTREE_ALWAYS_INLINE bool is_valid_header(const std::byte* bytes,
                                           std::uint32_t number_bits) noexcept {
  const ClusterHeaderView header(bytes);
  // trailing, base_shift and two of width; the third, with three fields of bits.
  const std::uint64_t most_first = number_bits == 64 ? 0x40403f3f3f3f3f3fu : 0x20201f1f1f1f1f1fu;
  const std::uint64_t most_second = number_bits == 64 ? 0x40040b10u : 0x20040b10u;
  static_assert(ClusterHeader::kMostStartBits == 0x10 && ClusterHeader::kMostFirstBits == 0xb &&
                ClusterHeader::kMostOldBits == 0x4);
  const std::uint64_t second =
      load<std::uint32_t>(bytes + offsetof(ClusterHeader, start_bits) - 1) >> 8 | header.width(2)
                                                                                      << 24;
  using cluster_detail::above;
  const bool are_fields_valid =
      (above(load<std::uint64_t>(bytes), most_first) | above(second, most_second)) == 0;
  const std::uint32_t size = header.group_size();
  return are_fields_valid &&
         size - ClusterHeader::kLeastGroupSize <=
             ClusterHeader::kMostGroupSize - ClusterHeader::kLeastGroupSize &&
         header.vertex_count() - 1u < ClusterHeader::kMostGroups * size;
}

/// Finds cluster `number`, but not its groups. False if it is corrupt. Precondition: it exists, and
/// so does the table.
BOXTREE_ALWAYS_INLINE bool find_cluster(const ClusterView& view, std::uint32_t number,
                                        Cluster& out) noexcept {
  out.number_bits = view.numbers == ClusterNumbers::kF64 ? 64 : 32;
  const std::uint32_t fixed = sizeof(ClusterHeader) + 3 * out.number_bits / 8;
  const std::uint64_t start = load<std::uint32_t>(view.bytes.data(), number) * kClusterUnit;
  if (!in_range(start, fixed + kClusterPadding, view.bytes.size())) return false;
  out.bytes = view.bytes.data() + start;
  out.size = view.bytes.size() - start - kClusterPadding;
  const ClusterHeaderView header = out.header();
  if (!is_valid_header(out.bytes, out.number_bits)) return false;
  const std::uint32_t faces = std::min(view.face_count - number * kClusterFaces, kClusterFaces);
  const auto leaves = static_cast<std::uint32_t>(leaves_of(faces));
  out.table = 8 * fixed;
  out.entry_bits = header.start_bits() + header.first_bits();
  out.bases_at = fixed + (leaves * out.entry_bits + 7) / 8;
  out.groups = (header.vertex_count() + header.group_size() - 1) / header.group_size();
  out.wider_at = out.bases_at + 3 * out.groups;
  out.vertices_at = out.wider_at + 3 * out.wider_bytes();
  return header.leaves_at() <= out.size && out.vertices_at <= header.leaves_at();
}

/// Finds the groups of a cluster that was found. False if they are corrupt.
bool find_groups(const Cluster& cluster, ClusterGroups& out) noexcept;

/// Finds leaf `leaf` of a cluster. False if its place is corrupt. Precondition: the cluster has it.
BOXTREE_ALWAYS_INLINE bool find_leaf(const Cluster& cluster, std::uint32_t leaf,
                                     ClusterLeafPlace& out) noexcept {
  const ClusterHeaderView header = cluster.header();
  const auto entry = static_cast<std::uint32_t>(
      read_bits(cluster.bytes, cluster.table + leaf * cluster.entry_bits, cluster.entry_bits));
  constexpr std::uint32_t kSlopeBits = ClusterHeader::kSlopeBits;
  // Both wrap where they would be negative.
  out.first = (entry >> header.start_bits()) + (leaf * header.first_slope() >> kSlopeBits) -
              header.first_bias();
  out.byte = header.leaves_at() + (leaf * header.start_slope() >> kSlopeBits) +
             static_cast<std::uint32_t>(entry & low_bits(header.start_bits())) -
             header.start_bias();
  return out.byte <= cluster.size;
}

/// The cluster that was read last, so that its other leaves need not find it again.
struct FoundCluster {
  const std::byte* section = nullptr;  // null before any was found
  std::uint32_t number = 0;
  Cluster cluster;
  ClusterGroups groups;
};

/// Decodes leaf `leaf`: faces 8 leaf to 8 leaf + 7, or up to the last. False when its bytes are
/// corrupt. Reads nothing outside `clusters`, whatever the bytes. `fields` may be null.
/// Precondition: the leaf exists, and there are cluster_table_bytes.
[[nodiscard]] bool decode_cluster_leaf(const ClusterView& clusters, std::uint32_t leaf,
                                       FoundCluster& found, ClusterLeaf& out,
                                       ClusterLeafFields* fields = nullptr) noexcept;

}  // namespace boxtree

#undef BOXTREE_ALWAYS_INLINE
