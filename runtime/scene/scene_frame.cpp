// SPDX-License-Identifier: MIT
#include "runtime/scene/scene_frame.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "format/limits.h"
#include "runtime/scene/placement.h"

namespace boxtree {
namespace {

// The largest extent of a tree is below 2^kExtentExponent, as for every tree (TreeRecord).
constexpr int kExtentExponent = 15;

}  // namespace

Frame frame_around(std::span<const Box<double>> boxes, int& exponent) noexcept {
  exponent = 0;
  if (boxes.empty()) return {};
  Box<double> bounds = empty_box<double>();
  for (const Box<double>& box : boxes) expand(bounds, box);
  std::array<double, 3> middle;
  double largest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    middle[k] = bounds.low[k] / 2 + bounds.high[k] / 2;
    largest = std::max(largest, bounds.high[k] / 2 - bounds.low[k] / 2);
  }
  if (largest >
      PlacementBounds::kLeastError) {  // else a point at the origin, by whose box is wider
    static_cast<void>(std::frexp(largest, &exponent));  // largest < 2^exponent; half an extent
    exponent = std::clamp(exponent + 1 - kExtentExponent, -kMaxScaleExponent, kMaxScaleExponent);
  }
  return {middle, exponent};
}

}  // namespace boxtree
