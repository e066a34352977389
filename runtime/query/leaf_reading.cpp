// SPDX-License-Identifier: MIT
// Reading, moving and bounding the triangles of two leaves.
#include "runtime/query/leaf_reading.h"

#include <cstddef>

#include "runtime/walk/read_leaf.h"
#include "runtime/walk/traversal.h"

namespace boxtree {

Errc LeafReading::read(NodeRef first_leaf, NodeRef second_leaf) noexcept {
  if (const Errc error = read_first(first_leaf); error != Errc::kOk) return error;
  return read_second(second_leaf);
}

Errc LeafReading::read_first(NodeRef leaf) noexcept {
  if (leaf == first_read_) return Errc::kOk;
  first_read_ = kNone;
  const Errc error = read_leaf(first_tree_, leaf, first);
  if (error != Errc::kOk) return error;
  for (std::uint32_t i = 0; i < first.count; ++i) first_bounds[i] = bounds_of(first.triangle(i));
  first_read_ = leaf;
  return Errc::kOk;
}

Errc LeafReading::read_second(NodeRef leaf) noexcept {
  if (leaf == second_read_) return Errc::kOk;
  second_read_ = kNone;
  const Errc error = read_leaf(second_tree_, leaf, second);
  if (error != Errc::kOk) return error;
  all_moved_bounds = empty_box<double>();
  for (std::uint32_t j = 0; j < second.count; ++j) {
    const Triangle triangle = second.triangle(j);
    for (std::size_t c = 0; c < 3; ++c) {
      moved[j].corner[c] = pose_.to_first().apply(triangle.corner[c]);
      // Outside the root box that the pose was checked with.
      if (!is_within_range(moved[j].corner[c])) return Errc::kVertexNotFinite;
    }
    moved_bounds[j] = bounds_of(moved[j]);
    expand(all_moved_bounds, moved_bounds[j]);
  }
  second_read_ = leaf;
  return Errc::kOk;
}

}  // namespace boxtree
