// SPDX-License-Identifier: MIT
// Constants of vectors that lie in memory, and are not constants to compilers: those would put them
// into instructions, and make each vector of them by two more that need the one port of a processor
// that moves lanes, which is the busiest where leaves are decoded.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace boxtree {

struct LaneConstants {
  /// The largest number that is in `number`.
  static constexpr std::uint32_t kMost = 0xff;
  /// Numbers of `lanes`, in order.
  static constexpr std::array<std::uint32_t, 11> kInLanes = {
      1, 2, 5, 6, 7, 31, 63, 127, 0x80000000, 0x80020100, 0x80808000};

  /// Row i: number kInLanes[i] in each lane.
  alignas(32) std::array<std::array<std::uint32_t, 8>, kInLanes.size()> lanes;
  /// Element i: i.
  std::array<std::uint32_t, kMost + 1> number;
  /// Element i: i low bits.
  std::array<std::uint32_t, 16> low_bits;
};

extern const LaneConstants kLaneConstants;

/// Eight lanes of one of LaneConstants::kInLanes.
template <std::uint32_t kNumber>
[[nodiscard]] inline const std::array<std::uint32_t, 8>& lane_constant() noexcept {
  constexpr auto& kAll = LaneConstants::kInLanes;
  constexpr auto kRow = std::find(kAll.begin(), kAll.end(), kNumber) - kAll.begin();
  static_assert(kRow < static_cast<std::ptrdiff_t>(kAll.size()));
  return kLaneConstants.lanes[kRow];
}

}  // namespace boxtree
