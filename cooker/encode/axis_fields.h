// SPDX-License-Identifier: MIT
// How one axis of a cluster is stored: the fields of ClusterHeader (format/cluster.h) that take the
// fewest bits.
#pragma once

#include <bit>
#include <cstdint>
#include <span>

namespace boxtree::cooker {

/// How one axis of a cluster is stored.
struct AxisFields {
  std::uint8_t base_bits = 0;
  std::uint8_t base_shift = 0;
  std::uint8_t width = 0;
  std::uint8_t wider_bits = 0;
  std::uint64_t cost = ~std::uint64_t{0};  // bits
};

/// The numbers of the vertices that a leaf stores, on one axis, less the least of the cluster.
struct AxisRange {
  std::uint64_t low = 0;
  std::uint64_t high = 0;
  std::uint32_t vertices = 0;

  [[nodiscard]] std::uint32_t width(std::uint32_t shift) const {
    return vertices == 0
               ? 0
               : static_cast<std::uint32_t>(std::bit_width(high - (low >> shift << shift)));
  }
  [[nodiscard]] std::uint64_t base(std::uint32_t shift) const {
    return vertices == 0 ? 0 : low >> shift;
  }
};

/// The fields that take the fewest bits, over all leaves of a cluster.
[[nodiscard]] AxisFields best_fields(std::span<const AxisRange> leaves);

}  // namespace boxtree::cooker
