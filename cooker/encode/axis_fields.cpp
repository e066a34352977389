// SPDX-License-Identifier: MIT
#include "cooker/encode/axis_fields.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "format/cluster.h"

namespace boxtree::cooker {

AxisFields best_fields(std::span<const AxisRange> leaves) {
  std::uint64_t largest = 0;
  for (const AxisRange& leaf : leaves) largest = std::max(largest, leaf.high);
  AxisFields best;
  const auto shifts = static_cast<std::uint32_t>(std::bit_width(largest));
  for (std::uint32_t shift = 0; shift <= std::min(shifts, 63u); ++shift) {
    std::uint32_t widest = 0;
    std::uint64_t largest_base = 0;
    std::array<std::uint32_t, 65> vertices_of{};  // by the width of their leaf
    for (const AxisRange& leaf : leaves) {
      widest = std::max(widest, leaf.width(shift));
      largest_base = std::max(largest_base, leaf.base(shift));
      vertices_of[leaf.width(shift)] += leaf.vertices;
    }
    const auto base_bits = static_cast<std::uint32_t>(std::bit_width(largest_base));
    for (std::uint32_t bits = 0; base_bits + bits <= ClusterHeader::kMostEntryBits; ++bits) {
      if ((1u << bits) - 1 > widest) break;
      const std::uint32_t narrowest = widest - ((1u << bits) - 1);
      std::uint64_t cost = leaves.size() * (base_bits + bits);
      for (std::uint32_t width = 0; width <= widest; ++width) {
        cost += std::uint64_t{vertices_of[width]} * std::max(width, narrowest);
      }
      if (cost >= best.cost) continue;
      best = {static_cast<std::uint8_t>(base_bits), static_cast<std::uint8_t>(shift),
              static_cast<std::uint8_t>(narrowest), static_cast<std::uint8_t>(bits), cost};
    }
  }
  return best;
}

}  // namespace boxtree::cooker
