// SPDX-License-Identifier: MIT
// A sphere query in vectors of float.
#if defined(BOXTREE_RUNTIME_QUERY_SPHERE_FILTER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXTREE_RUNTIME_QUERY_SPHERE_FILTER_INL_H
#undef BOXTREE_RUNTIME_QUERY_SPHERE_FILTER_INL_H
#else
#define BOXTREE_RUNTIME_QUERY_SPHERE_FILTER_INL_H
#endif

#include "runtime/query/distance-inl.h"
#include "runtime/query/point_filter.h"
#include "runtime/query/shape_query.h"
#include "runtime/walk/overlap-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
#if HWY_TARGET != HWY_SCALAR

class SphereFilter {
 public:
  SphereFilter(const BoundTree& tree, const SphereQuery& query)
      : center_(tree.largest_abs(), query.center),
        above_(PointFilter::above(query.squared_radius)),
        below_(PointFilter::below(query.certain_squared_radius)) {}

  HWY_INLINE Classification classify(const VectorBox& box) const {
    const Floats d;
    return {bits_of(hn::Le(nearest_squared(center_, box), hn::Set(d, above_))),
            bits_of(hn::Le(farthest_squared(center_, box), hn::Set(d, below_)))};
  }
  HWY_INLINE Classification classify(const VectorTriangle& triangle) const {
    return classify_corners(*this, triangle);
  }
  HWY_INLINE std::uint32_t contained(const VectorPoint& point) const {
    return bits_of(hn::Le(farthest_squared(center_, box_at(point)), hn::Set(Floats(), below_)));
  }

 private:
  PointFilter center_;
  float above_, below_;  // squared radius
};

#endif
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
