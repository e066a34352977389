// SPDX-License-Identifier: MIT
// How far the children of a node are from a subtree of another tree, at least: what the search for
// a distance computes most often, so eight children at a time where there are vectors.
#pragma once

#include <array>
#include <cstddef>

#include <boxtree/query.h>

#include "format/children.h"
#include "runtime/query/pair_work.h"
#include "runtime/query/relative_pose.h"
#include "runtime/query/world_metric.h"
#include "runtime/tree/bound_tree.h"
#include "runtime/walk/erased_codec.h"

namespace boxtree {

/// From the space of the tree with the children, the first one's or the second's: `tree` is 0 or 1.
struct GapMaps {
  const AffineMap& to_other;
  const GapWeights& here;
  const GapWeights& there;  // in the other tree's space
  const AlignedAxes& axes;
  std::size_t tree;
};

/// What the children are compared with.
struct OtherSubtree {
  Box<double> box;     // in its own space
  Box<double> image;   // its hull in the children's space
  Box<double> extent;  // along the axes
};

/// Of each child. All are computed whatever another has shown, so that they are the same numbers
/// however they are.
struct ChildGaps {
  template <class T>
  using OfEach = std::array<T, ErasedCodec::Children::kWidth>;

  std::array<OfEach<double>, 3> low, high;  // extents of boxes along the axes
  OfEach<double> along;                     // lower bounds of squared distances, by these extents
  OfEach<double> apart;                     // and by boxes in either space

  [[nodiscard]] Box<double> extent(std::uint32_t i) const noexcept {
    return {{low[0][i], low[1][i], low[2][i]}, {high[0][i], high[1][i], high[2][i]}};
  }
};

/// Decodes a node, counts it and compares its children.
[[nodiscard]] Errc expand_with_gaps(const BoundTree& tree, PairBound& bound, NodeRef node,
                                    const Box<double>& box, const GapMaps& maps,
                                    const OtherSubtree& other, ErasedCodec::Children& children,
                                    ChildGaps& gaps) noexcept;

/// The extent along the axes of all triangles of a leaf, in their own space.
[[nodiscard]] Box<double> extent_of(const AlignedAxes& axes, std::size_t tree,
                                    const TriangleBatch& triangles) noexcept;

/// One by one.
[[nodiscard]] Errc expand_with_gaps_scalar(const BoundTree& tree, PairBound& bound, NodeRef node,
                                           const Box<double>& box, const GapMaps& maps,
                                           const OtherSubtree& other,
                                           ErasedCodec::Children& children,
                                           ChildGaps& gaps) noexcept;
[[nodiscard]] Box<double> extent_scalar(const AlignedAxes& axes, std::size_t tree,
                                        const TriangleBatch& triangles) noexcept;

/// By vectors; precondition: the tree has wide nodes. Not in builds without vectors.
[[nodiscard]] Errc expand_with_gaps_wide(const BoundTree& tree, PairBound& bound, NodeRef node,
                                         const Box<double>& box, const GapMaps& maps,
                                         const OtherSubtree& other, ErasedCodec::Children& children,
                                         ChildGaps& gaps) noexcept;
[[nodiscard]] Box<double> extent_wide(const AlignedAxes& axes, std::size_t tree,
                                      const TriangleBatch& triangles) noexcept;

}  // namespace boxtree
