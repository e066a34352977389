// SPDX-License-Identifier: MIT
// Reads a leaf of each tree and moves the triangles of the second into the first one's space.
#pragma once

#include <array>
#include <cstdint>

#include <boxtree/query.h>

#include "format/box.h"
#include "format/children.h"
#include "format/limits.h"
#include "runtime/primitive/triangle.h"
#include "runtime/query/relative_pose.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree {

/// The same leaf is often needed several times in a row, so the last ones read are kept. Everything
/// passed by reference must outlive it.
class LeafReading {
 public:
  LeafReading(const BoundTree& first_tree, const BoundTree& second_tree,
              const RelativePose& pose) noexcept
      : first_tree_(first_tree), second_tree_(second_tree), pose_(pose) {}

  /// Errors: those of corrupt leaves.
  [[nodiscard]] Errc read(NodeRef first_leaf, NodeRef second_leaf) noexcept;

  // What was read last.
  TriangleBatch first;
  TriangleBatch second;
  std::array<Box<double>, kMaxLeafTriangles> first_bounds;
  std::array<Triangle, kMaxLeafTriangles> moved;  // the second leaf in the first tree's space
  std::array<Box<double>, kMaxLeafTriangles> moved_bounds;
  Box<double> all_moved_bounds;

 private:
  Errc read_first(NodeRef leaf) noexcept;
  Errc read_second(NodeRef leaf) noexcept;

  static constexpr NodeRef kNone{0xffffffffu, 0xffffffffu};

  const BoundTree& first_tree_;
  const BoundTree& second_tree_;
  const RelativePose& pose_;
  NodeRef first_read_ = kNone;  // the leaf that `first` holds
  NodeRef second_read_ = kNone;
};

}  // namespace boxtree
