// SPDX-License-Identifier: MIT
// The decoded boxes of a tree, level by level.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "format/limits.h"
#include "runtime/tree/bound_tree.h"
#include "runtime/walk/work.h"

namespace boxtree::cooker {

/// Levels first..last. The root's box is level 0; the boxes that a node expands to, including
/// leaves, are one level below it.
struct LevelRange {
  std::uint32_t first = 0;
  std::uint32_t last = 0;
};

/// Boxes that form one group in the output: those of one level, or those of all leaves.
struct BoxGroup {
  std::optional<std::uint32_t> level;  // nothing: the leaves
  std::uint64_t count = 0;

  [[nodiscard]] bool has(std::uint32_t box_level, bool is_leaf) const {
    return level ? *level == box_level : is_leaf;
  }
  [[nodiscard]] std::string name() const {
    return level ? "level " + std::to_string(*level) : "leaves";
  }
};

/// Calls visit(level, is_leaf, Box<double>) for the boxes of levels 0 to `deepest`: each box before
/// those below it, children in order. Boxes are in tree space. Ends on any bytes (WalkBound).
/// Errors: kNodeCorrupt and kDepthExceeded for corrupt bytes.
template <class Visit>
[[nodiscard]] Errc walk_boxes(const Tree& tree, std::uint32_t deepest, Visit visit) {
  struct Entry {
    Node node;
    std::uint32_t level;
  };
  if (tree.empty()) return Errc::kOk;
  std::vector<Entry> stack = {{BoundTree::of(tree).root(), 0}};
  NodeChildren children;
  WalkBound bound(BoundTree::of(tree).node_count());
  while (!stack.empty()) {
    const Entry entry = stack.back();
    stack.pop_back();
    const Box<double>& box = entry.node.box;
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(box.low[k] <= box.high[k])) return Errc::kNodeCorrupt;  // NaN too
    }
    visit(entry.level, entry.node.is_leaf, box);
    if (entry.node.is_leaf) continue;
    if (entry.level >= kMaxDepth) return Errc::kDepthExceeded;
    if (entry.level >= deepest) continue;
    const Errc error = bound.count(BoundTree::of(tree).expand(entry.node, children));
    if (error != Errc::kOk) return error;
    for (std::uint32_t i = children.count; i-- > 0;) {
      stack.push_back({children.child[i], entry.level + 1});
    }
  }
  return Errc::kOk;
}

/// The boxes of one group. Precondition: find_groups() succeeded on this tree.
template <class Visit>
void visit_group(const Tree& tree, const BoxGroup& group, Visit visit) {
  static_cast<void>(walk_boxes(tree, group.level.value_or(kMaxDepth),
                               [&](std::uint32_t level, bool is_leaf, const Box<double>& box) {
                                 if (group.has(level, is_leaf)) visit(box);
                               }));
}

/// The selected groups that have boxes: levels in ascending order, then the leaves. Errors: as
/// walk_boxes, with the tree's name.
Result<std::vector<BoxGroup>> find_groups(const Tree& tree, const std::vector<LevelRange>& levels,
                                          bool leaves);

/// The edges of a box as pairs of corner numbers. Bits of a corner number select low or high: x is
/// bit 0, y bit 1, z bit 2.
inline constexpr std::array<std::array<std::uint32_t, 2>, 12> kBoxEdges = {{{0, 1},
                                                                            {2, 3},
                                                                            {4, 5},
                                                                            {6, 7},
                                                                            {0, 2},
                                                                            {1, 3},
                                                                            {4, 6},
                                                                            {5, 7},
                                                                            {0, 4},
                                                                            {1, 5},
                                                                            {2, 6},
                                                                            {3, 7}}};

/// The sides of a box, counter-clockwise seen from outside.
inline constexpr std::array<std::array<std::uint32_t, 4>, 6> kBoxSides = {
    {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};

/// The largest f32 that is not above `value`; the outermost finite one if there is no such finite
/// f32.
[[nodiscard]] float f32_below(double value);
/// The smallest f32 that is not below `value`; likewise.
[[nodiscard]] float f32_above(double value);

}  // namespace boxtree::cooker
