// SPDX-License-Identifier: MIT
#include "runtime/walk/lane_constants.h"

namespace boxtree {

const LaneConstants kLaneConstants = [] {
  LaneConstants constants{};
  for (std::size_t row = 0; row < constants.lanes.size(); ++row) {
    constants.lanes[row].fill(LaneConstants::kInLanes[row]);
  }
  for (std::uint32_t i = 0; i < constants.number.size(); ++i) constants.number[i] = i;
  for (std::uint32_t i = 0; i < constants.low_bits.size(); ++i) {
    constants.low_bits[i] = (1u << i) - 1;
  }
  return constants;
}();

}  // namespace boxtree
