// SPDX-License-Identifier: MIT
#include "runtime/query/child_gaps.h"

#include <algorithm>
#include <cstdint>

#include "runtime/walk/traversal.h"
#include "runtime/walk/walk_tree.h"

namespace boxtree {

Errc expand_with_gaps_scalar(const BoundTree& tree, PairBound& bound, NodeRef node,
                             const Box<double>& box, const GapMaps& maps, const OtherSubtree& other,
                             ErasedCodec::Children& children, ChildGaps& gaps) noexcept {
  const Errc error = bound.count(ErasedCodec{&tree}.expand(node, box, children));
  if (error != Errc::kOk) return error;
  for (std::uint32_t i = 0; i < children.count; ++i) {
    const Box<double> child = children.box(i);
    const Box<double> extent = maps.axes.map(maps.tree).hull(child);
    for (std::size_t k = 0; k < 3; ++k) {
      gaps.low[k][i] = extent.low[k];
      gaps.high[k][i] = extent.high[k];
    }
    gaps.along[i] = maps.axes.squared_distance(extent, other.extent);
    gaps.apart[i] = std::max(maps.here.squared_distance(child, other.image),
                             maps.there.squared_distance(maps.to_other.hull(child), other.box));
  }
  return Errc::kOk;
}

Box<double> extent_scalar(const AlignedAxes& axes, std::size_t tree,
                          const TriangleBatch& triangles) noexcept {
  Box<double> all = empty_box<double>();
  for (std::uint32_t i = 0; i < triangles.count; ++i) {
    expand(all, axes.extent_of(tree, triangles.triangle(i)));
  }
  return all;
}

Errc expand_with_gaps(const BoundTree& tree, PairBound& bound, NodeRef node, const Box<double>& box,
                      const GapMaps& maps, const OtherSubtree& other,
                      ErasedCodec::Children& children, ChildGaps& gaps) noexcept {
  if constexpr (kWalksTreesByVectors) {
    if (has_wide_nodes(tree)) {
      return expand_with_gaps_wide(tree, bound, node, box, maps, other, children, gaps);
    }
  }
  return expand_with_gaps_scalar(tree, bound, node, box, maps, other, children, gaps);
}

Box<double> extent_of(const AlignedAxes& axes, std::size_t tree,
                      const TriangleBatch& triangles) noexcept {
  if constexpr (kWalksTreesByVectors) return extent_wide(axes, tree, triangles);
  return extent_scalar(axes, tree, triangles);
}

}  // namespace boxtree
