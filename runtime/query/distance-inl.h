// SPDX-License-Identifier: MIT
// Bounds of the squared distance from a point to boxes.
#if defined(BOXTREE_RUNTIME_QUERY_DISTANCE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXTREE_RUNTIME_QUERY_DISTANCE_INL_H
#undef BOXTREE_RUNTIME_QUERY_DISTANCE_INL_H
#else
#define BOXTREE_RUNTIME_QUERY_DISTANCE_INL_H
#endif

#include "runtime/query/point_filter.h"
#include "runtime/walk/decode-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {

/// No point of a box is nearer.
HWY_INLINE FloatVector nearest_squared(const PointFilter& point, const VectorBox& box) {
  const Floats d;
  FloatVector sum = hn::Zero(d);
  for (std::size_t k = 0; k < 3; ++k) {
    const FloatVector below = hn::Sub(box.low[k], hn::Set(d, point.high[k]));
    const FloatVector above = hn::Sub(hn::Set(d, point.low[k]), box.high[k]);
    const FloatVector outside = hn::Max(hn::Zero(d), hn::Max(below, above));
    sum = hn::MulAdd(outside, outside, sum);
  }
  return sum;
}

/// No point of a box is farther.
HWY_INLINE FloatVector farthest_squared(const PointFilter& point, const VectorBox& box) {
  const Floats d;
  FloatVector sum = hn::Zero(d);
  for (std::size_t k = 0; k < 3; ++k) {
    const FloatVector across = hn::Max(hn::Sub(box.high[k], hn::Set(d, point.low[k])),
                                       hn::Sub(hn::Set(d, point.high[k]), box.low[k]));
    sum = hn::MulAdd(across, across, sum);
  }
  return sum;
}

}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
