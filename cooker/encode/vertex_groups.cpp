// SPDX-License-Identifier: MIT
#include "cooker/encode/vertex_groups.h"

#include <algorithm>
#include <bit>

#include "format/cluster.h"

namespace boxtree::cooker {
namespace {

using Offset = std::array<std::uint64_t, 3>;
using Header = ClusterHeader;

struct Range {
  Offset low, high;
};

std::vector<Range> ranges_of(std::span<const Offset> offset, std::size_t size) {
  std::vector<Range> ranges;
  for (std::size_t first = 0; first < offset.size(); first += size) {
    Range range{offset[first], offset[first]};
    for (const Offset& each : offset.subspan(first, std::min(size, offset.size() - first))) {
      for (std::size_t k = 0; k < 3; ++k) {
        range.low[k] = std::min(range.low[k], each[k]);
        range.high[k] = std::max(range.high[k], each[k]);
      }
    }
    ranges.push_back(range);
  }
  return ranges;
}

VertexGroups groups_of(std::span<const Offset> offset, std::size_t size) {
  const std::vector<Range> ranges = ranges_of(offset, size);
  VertexGroups out;
  out.size = static_cast<std::uint32_t>(size);
  out.group.resize(ranges.size());
  for (std::size_t k = 0; k < 3; ++k) {
    std::uint64_t largest = 0;
    for (const Range& range : ranges) largest = std::max(largest, range.low[k]);
    const auto bits = static_cast<std::uint32_t>(std::bit_width(largest));
    const std::uint32_t shift = bits > Header::kBaseBits ? bits - Header::kBaseBits : 0;
    std::uint32_t widest = 0;
    for (std::size_t g = 0; g < ranges.size(); ++g) {
      VertexGroup& group = out.group[g];
      group.base[k] = ranges[g].low[k] >> shift;
      group.width[k] =
          static_cast<std::uint32_t>(std::bit_width(ranges[g].high[k] - (group.base[k] << shift)));
      widest = std::max(widest, group.width[k]);
    }
    constexpr std::uint32_t kMostWider = (1u << Header::kWiderBits) - 1;
    std::uint32_t narrowest = widest;
    for (const VertexGroup& group : out.group) narrowest = std::min(narrowest, group.width[k]);
    narrowest = std::max(narrowest, widest - std::min(widest, kMostWider));
    for (VertexGroup& group : out.group) group.width[k] = std::max(group.width[k], narrowest);
    out.base_shift[k] = static_cast<std::uint8_t>(shift);
    out.narrowest[k] = static_cast<std::uint8_t>(narrowest);
  }
  return out;
}

// Bits of all vertices, and of what groups have of their own.
std::uint64_t cost_of(const VertexGroups& groups, std::size_t vertices) {
  std::uint64_t bits = groups.group.size() * 3 * (Header::kBaseBits + Header::kWiderBits);
  for (const VertexGroup& group : groups.group) {
    const std::size_t count = std::min<std::size_t>(groups.size, vertices);
    bits += count * group.stride();
    vertices -= count;
  }
  return bits;
}

}  // namespace

VertexGroups best_groups(std::span<const Offset> offset) {
  VertexGroups best;
  std::uint64_t least = ~std::uint64_t{0};
  for (std::size_t count = Header::kMostGroups; count != 0; --count) {
    const std::size_t size =
        std::max<std::size_t>(Header::kLeastGroupSize, (offset.size() + count - 1) / count);
    // The largest groups hold any cluster, but are not read by vectors.
    if (size > Header::kFastGroupSize && best.size != 0) break;
    if (size == best.size) continue;
    VertexGroups groups = groups_of(offset, size);
    const std::uint64_t cost = cost_of(groups, offset.size());
    if (cost >= least) continue;
    least = cost;
    best = std::move(groups);
  }
  return best;
}

}  // namespace boxtree::cooker
