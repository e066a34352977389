// SPDX-License-Identifier: MIT
// Finds the levels of a tree, and rounds boxes outward.
#include "cooker/export/tree_boxes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace boxtree::cooker {

Result<std::vector<BoxGroup>> find_groups(const Tree& tree, const std::vector<LevelRange>& levels,
                                          bool leaves) {
  std::array<bool, kMaxDepth + 1> chosen{};
  std::uint32_t deepest = 0;
  for (const LevelRange& range : levels) {
    for (std::uint32_t level = range.first; level <= std::min(range.last, kMaxDepth); ++level) {
      chosen[level] = true;
      deepest = std::max(deepest, level);
    }
  }
  std::vector<BoxGroup> groups;
  if (levels.empty() && !leaves) return groups;
  std::array<std::uint64_t, kMaxDepth + 1> level_count{};
  std::uint64_t leaf_count = 0;
  const Errc error = walk_boxes(tree, leaves ? kMaxDepth : deepest,
                                [&](std::uint32_t level, bool is_leaf, const Box<double>&) {
                                  ++level_count[level];
                                  leaf_count += is_leaf ? 1u : 0u;
                                });
  if (error != Errc::kOk) {
    return Error{error, std::string(tree.name()) + ": its nodes contradict themselves"};
  }
  for (std::uint32_t level = 0; level <= kMaxDepth; ++level) {
    if (chosen[level] && level_count[level] > 0) groups.push_back({level, level_count[level]});
  }
  if (leaves && leaf_count > 0) groups.push_back({std::nullopt, leaf_count});
  return groups;
}

float f32_below(double value) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  if (value >= kLargest) return kLargest;
  if (value <= -kLargest) return -kLargest;
  const auto nearest = static_cast<float>(value);
  if (nearest <= value) return nearest;
  return std::nextafter(nearest, -std::numeric_limits<float>::infinity());
}

float f32_above(double value) {
  return -f32_below(-value);
}

}  // namespace boxtree::cooker
