// SPDX-License-Identifier: MIT
// Gaps of children of wide nodes: each operation of child_gaps.cpp, in its order, for several
// children at once.
#include "runtime/query/child_gaps.h"
#include "runtime/walk/targets.h"
#include "runtime/walk/traversal.h"

#ifndef HWY_TARGET_INCLUDE  // compiled alone
#define HWY_TARGET_INCLUDE "runtime/query/child_gaps_wide.cpp"
#endif
#include <hwy/foreach_target.h>
// Highway's headers must come after foreach_target.h.
#include <hwy/highway.h>

#include "runtime/walk/expand-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
namespace {

#if !BOXTREE_HAS_SPECIAL_WALKS
Errc expand_children(const BoundTree& tree, PairBound& bound, NodeRef node, const Box<double>& box,
                     const GapMaps& maps, const OtherSubtree& other,
                     ErasedCodec::Children& children, ChildGaps& gaps) {
  return expand_with_gaps_scalar(tree, bound, node, box, maps, other, children, gaps);
}
Box<double> extent_of_triangles(const AlignedAxes& axes, std::size_t tree,
                                const TriangleBatch& triangles) {
  return extent_scalar(axes, tree, triangles);
}
#else
HWY_INLINE DoubleVector every(double number) {
  return hn::Set(Doubles(), number);
}

// AffineMap::hull().
HWY_INLINE DoubleBoxes hull(const AffineMap& map, const DoubleBoxes& boxes) {
  DoubleBoxes image;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    image.low[i] = image.high[i] = every(map.translation[row]);
    for (std::size_t j = 0; j < 3; ++j) {
      const DoubleVector m = every(map.linear(row, static_cast<Eigen::Index>(j)));
      const DoubleVector a = hn::Mul(m, boxes.low[j]), b = hn::Mul(m, boxes.high[j]);
      image.low[i] = hn::Add(image.low[i], hn::Min(a, b));
      image.high[i] = hn::Add(image.high[i], hn::Max(a, b));
    }
  }
  return image;
}

// GapWeights::squared_distance(). Never NaN either.
HWY_INLINE DoubleVector squared_distance(const GapWeights& weights, const DoubleBoxes& boxes,
                                         const Box<double>& other) {
  const DoubleVector zero = hn::Zero(Doubles());
  DoubleVector sum = zero, largest = zero;
  for (std::size_t k = 0; k < 3; ++k) {
    const DoubleVector apart = hn::Max(hn::Sub(boxes.low[k], every(other.high[k])),
                                       hn::Sub(every(other.low[k]), boxes.high[k]));
    const DoubleVector weighted =
        hn::Mul(hn::Sub(apart, every(weights.margin[k])), every(weights.weight[k]));
    const DoubleVector gap = hn::IfThenElseZero(hn::Gt(weighted, zero), weighted);
    const DoubleVector square = hn::Mul(gap, gap);
    sum = hn::Add(sum, square);
    largest = hn::Max(largest, square);
  }
  return hn::Max(largest, hn::Mul(every(weights.combined), sum));
}

Errc expand_children(const BoundTree& tree, PairBound& bound, NodeRef node, const Box<double>& box,
                     const GapMaps& maps, const OtherSubtree& other,
                     ErasedCodec::Children& children, ChildGaps& gaps) {
  return expand_in_doubles(
      tree, bound, node, box, children, [&](std::size_t i, const DoubleBoxes& boxes) HWY_ATTR {
        const Doubles d;
        const DoubleBoxes extents = hull(maps.axes.map(maps.tree), boxes);
        for (std::size_t k = 0; k < 3; ++k) {
          hn::StoreU(extents.low[k], d, gaps.low[k].data() + i);
          hn::StoreU(extents.high[k], d, gaps.high[k].data() + i);
        }
        hn::StoreU(squared_distance(maps.axes.weights(), extents, other.extent), d,
                   gaps.along.data() + i);
        const DoubleVector here = squared_distance(maps.here, boxes, other.image);
        const DoubleVector there =
            squared_distance(maps.there, hull(maps.to_other, boxes), other.box);
        hn::StoreU(hn::Max(here, there), d, gaps.apart.data() + i);
      });
}

Box<double> extent_of_triangles(const AlignedAxes& axes, std::size_t tree,
                                const TriangleBatch& triangles) {
  const Doubles d;
  const AffineMap& map = axes.map(tree);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  DoubleVector low[3], high[3];
  for (std::size_t k = 0; k < 3; ++k) {
    low[k] = every(kInfinity);
    high[k] = every(-kInfinity);
  }
  for (std::size_t i = 0; i < triangles.count; i += hn::MaxLanes(d)) {
    const auto is_there = hn::FirstN(d, triangles.count - i);
    for (const auto& corner : triangles.coordinate) {
      const DoubleVector x[3] = {hn::LoadU(d, corner[0].data() + i),
                                 hn::LoadU(d, corner[1].data() + i),
                                 hn::LoadU(d, corner[2].data() + i)};
      for (std::size_t k = 0; k < 3; ++k) {
        const auto row = static_cast<Eigen::Index>(k);
        DoubleVector y = every(map.translation[row]);
        for (std::size_t j = 0; j < 3; ++j) {
          y = hn::Add(y, hn::Mul(every(map.linear(row, static_cast<Eigen::Index>(j))), x[j]));
        }
        low[k] = hn::Min(low[k], hn::IfThenElse(is_there, y, low[k]));
        high[k] = hn::Max(high[k], hn::IfThenElse(is_there, y, high[k]));
      }
    }
  }
  Box<double> all;
  for (std::size_t k = 0; k < 3; ++k) {
    all.low[k] = hn::GetLane(hn::MinOfLanes(d, low[k]));
    all.high[k] = hn::GetLane(hn::MaxOfLanes(d, high[k]));
  }
  return all;
}
#endif

}  // namespace
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "runtime/walk/dispatch.h"

namespace boxtree {
namespace {

BOXTREE_EXPORT(expand_children);
BOXTREE_EXPORT(extent_of_triangles);

}  // namespace

Errc expand_with_gaps_wide(const BoundTree& tree, PairBound& bound, NodeRef node,
                           const Box<double>& box, const GapMaps& maps, const OtherSubtree& other,
                           ErasedCodec::Children& children, ChildGaps& gaps) noexcept {
  if (!tree.has_float_nodes())
    return expand_with_gaps_scalar(tree, bound, node, box, maps, other, children, gaps);
  return BOXTREE_DISPATCH(expand_children)(tree, bound, node, box, maps, other, children, gaps);
}

Box<double> extent_wide(const AlignedAxes& axes, std::size_t tree,
                        const TriangleBatch& triangles) noexcept {
  return BOXTREE_DISPATCH(extent_of_triangles)(axes, tree, triangles);
}

}  // namespace boxtree
#endif
