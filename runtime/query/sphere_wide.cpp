// SPDX-License-Identifier: MIT
// Sphere queries over the wide codecs.
#include "runtime/query/point_filter.h"
#include "runtime/query/shape_query.h"
#include "runtime/walk/erased_codec.h"
#include "runtime/walk/targets.h"
#include "runtime/walk/walk_tree.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/query/sphere_wide.cpp"
#include <hwy/foreach_target.h>
// Highway's headers must come after foreach_target.h.
#include <hwy/highway.h>

#include "runtime/query/distance-inl.h"
#include "runtime/walk/overlap-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR
Errc walk_sphere(const BoundTree& tree, FaceWalk<SphereQuery>& faces) {
  return traverse_overlap(tree, ErasedCodec{&tree}, faces);
}
#else
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

Errc walk_sphere(const BoundTree& tree, FaceWalk<SphereQuery>& faces) {
  return with_wide_codec<Errc>(
      tree, [&](const auto& codec) { return walk<SphereFilter>(tree, codec, faces); });
}
#endif

}  // namespace
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "runtime/walk/dispatch.h"

namespace boxtree {
namespace {

BOXTREE_EXPORT(walk_sphere);

}  // namespace

Errc walk_wide(const BoundTree& tree, FaceWalk<SphereQuery>& walk) {
  if (tree.has_float_nodes() && PointFilter::is_near(tree.largest_abs(), walk.shape.center)) {
    return BOXTREE_DISPATCH(walk_sphere)(tree, walk);
  }
  return traverse_overlap(tree, ErasedCodec{&tree}, walk);
}

}  // namespace boxtree
#endif
