// SPDX-License-Identifier: MIT
// The top level of a scene by vectors: which instances a box, a point or a ray may intersect.
#include <algorithm>

#include "runtime/query/point_filter.h"
#include "runtime/query/ray_filter.h"
#include "runtime/query/relative_pose.h"
#include "runtime/scene/top_level_walk.h"
#include "runtime/walk/targets.h"

#ifndef HWY_TARGET_INCLUDE  // compiled alone
#define HWY_TARGET_INCLUDE "runtime/scene/top_level_wide.cpp"
#endif
#include <hwy/foreach_target.h>
// Highway's headers must come after foreach_target.h.
#include <hwy/highway.h>

#include "runtime/query/distance-inl.h"
#include "runtime/walk/box_bounds-inl.h"
#include "runtime/walk/nearest-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR
Errc walk_box(const TopLevel& top, const Box<double>& box, InstanceVisitor visit) {
  return walk_top_level_scalar(top, box, visit);
}
Errc walk_point(const TopLevel& top, const Eigen::Vector3d& point, const double& bound,
                InstanceVisitor visit) {
  return walk_top_level_scalar(top, point, bound, visit);
}
Errc walk_ray(const TopLevel& top, const TopLevelRay& ray, double /*enter*/, const double& bound,
              InstanceVisitor visit) {
  return walk_top_level_scalar(top, ray, bound, visit);
}
#else
// The shape of a query against boxes: NearestWalk documents what `intersect` returns.
// `limit_of(bound)` is a float that only keys above the bound exceed.
struct BoxRegion {
  BoxBounds bounds;

  // All keys are equal: the order is unspecified.
  [[nodiscard]] static float limit_of(double /*bound*/) { return 0; }
  HWY_INLINE std::uint32_t intersect(const VectorBox& boxes, float /*limit*/,
                                     FloatVector& key) const {
    key = hn::Zero(Floats());
    return bounds.classify(boxes).touched;
  }
};

struct PointRegion {
  PointFilter point;

  [[nodiscard]] static float limit_of(double bound) { return PointFilter::above(bound); }
  HWY_INLINE std::uint32_t intersect(const VectorBox& boxes, float limit, FloatVector& key) const {
    key = nearest_squared(point, boxes);
    return bits_of(hn::Le(key, hn::Set(Floats(), limit)));
  }
};

struct RayRegion {
  RayBoxFilter ray;

  [[nodiscard]] float limit_of(double bound) const { return ray.bound(bound); }
  HWY_INLINE std::uint32_t intersect(const VectorBox& boxes, float limit, FloatVector& key) const {
    const Floats d;
    FloatVector leave = hn::Set(d, limit);
    key = hn::Zero(d);
    for (std::size_t k = 0; k < 3; ++k) {
      const bool from_high = ray.near_high[k] != 0;
      const FloatVector origin = hn::Set(d, ray.origin[k]);
      const FloatVector inverse = hn::Set(d, ray.inverse[k]);
      const FloatVector margin = hn::Set(d, ray.margin[k]);
      const FloatVector near = hn::Sub(from_high ? boxes.high[k] : boxes.low[k], origin);
      const FloatVector far = hn::Sub(from_high ? boxes.low[k] : boxes.high[k], origin);
      key = hn::Max(key, hn::MulSub(near, inverse, margin));
      leave = hn::Min(leave, hn::MulAdd(far, inverse, margin));
    }
    return bits_of(hn::Le(key, leave));
  }
};

// The query of NearestWalk whose leaves are instances.
template <class Region>
class Instances {
 public:
  Instances(const TopLevel& top, const Region& region, const double& bound, InstanceVisitor visit)
      : region_(region),
        best_(bound),
        limit_(region.limit_of(bound)),
        visit_(visit),
        nodes_(top.scene.node_count) {}

  [[nodiscard]] float bound() const { return limit_; }
  [[nodiscard]] WalkBound& nodes() { return nodes_; }
  HWY_INLINE std::uint32_t intersect(const VectorBox& boxes, FloatVector& key) const {
    return region_.intersect(boxes, limit_, key);
  }
  void expanding(const WideLinks& /*links*/, std::uint32_t /*passing*/) const {}
  [[nodiscard]] static bool reads_ahead() { return false; }
  bool leaf(std::uint32_t number, std::uint32_t /*next*/) {
    const bool go_on = visit_(number);
    limit_ = region_.limit_of(best_);
    return go_on;
  }

 private:
  const Region& region_;
  const double& best_;  // a visit may lower it
  float limit_;         // of keys
  InstanceVisitor visit_;
  WalkBound nodes_;
};

template <class Region>
Errc walk(const TopLevel& top, const Region& region, const double& bound, InstanceVisitor visit) {
  Instances<Region> instances(top, region, bound, visit);
  return NearestWalk<Wide8Node, Instances<Region>>(top.codec, instances).run(root_box<float>(top));
}

Errc walk_box(const TopLevel& top, const Box<double>& box, InstanceVisitor visit) {
  BoxRegion region;
  for (std::size_t k = 0; k < 3; ++k) region.bounds.set(k, box.low[k], box.high[k], 0);
  return walk(top, region, 0, visit);
}

Errc walk_point(const TopLevel& top, const Eigen::Vector3d& point, const double& bound,
                InstanceVisitor visit) {
  return walk(top, PointRegion{PointFilter(max_abs_of(top), point)}, bound, visit);
}

Errc walk_ray(const TopLevel& top, const TopLevelRay& ray, double enter, const double& bound,
              InstanceVisitor visit) {
  RayBoxFilter filter(ray.slab, AxisLanes(ray.origin), AxisLanes(ray.direction),
                      std::max(enter, ray.s_min),
                      RayBoxFilter::rounding(ray.near_of(top)) +
                          RayBoxFilter::given_away(largest_magnitude(ray.origin), ray.max_abs));
  filter.widen(ray.extent);
  return walk(top, RayRegion{filter}, bound, visit);
}
#endif

}  // namespace
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "runtime/walk/dispatch.h"

namespace boxtree {
namespace {

BOXTREE_EXPORT(walk_box);
BOXTREE_EXPORT(walk_point);
BOXTREE_EXPORT(walk_ray);

}  // namespace

Errc walk_top_level_wide(const TopLevel& top, const Box<double>& box, InstanceVisitor visit) {
  if (!top.has_float_nodes()) return walk_top_level_scalar(top, box, visit);
  if (!boxes_overlap(root_box<float>(top), box)) return Errc::kOk;
  return BOXTREE_DISPATCH(walk_box)(top, box, visit);
}

Errc walk_top_level_wide(const TopLevel& top, const Eigen::Vector3d& point, const double& bound,
                         InstanceVisitor visit) {
  if (!top.has_float_nodes() || !PointFilter::is_near(max_abs_of(top), point)) {
    return walk_top_level_scalar(top, point, bound, visit);
  }
  if (squared_distance(point, root_box<float>(top)) > bound) return Errc::kOk;
  return BOXTREE_DISPATCH(walk_point)(top, point, bound, visit);
}

Errc walk_top_level_wide(const TopLevel& top, const TopLevelRay& ray, const double& bound,
                         InstanceVisitor visit) {
  const double max_abs = max_abs_of(top);
  // A shape may be so large beside the tree that its size takes the digits; an ill-conditioned map
  // may widen the query by more than the tree's size; the filter is then useless.
  const double origin_max_abs = largest_magnitude(ray.origin);
  const bool is_near = origin_max_abs <= 0x1p30 * max_abs && ray.near_of(top) <= 0x1p10 * max_abs &&
                       RayBoxFilter::given_away(origin_max_abs, ray.max_abs) <= max_abs;
  if (!top.has_float_nodes() || !is_near) return walk_top_level_scalar(top, ray, bound, visit);
  const double enter = ray.slab.key(root_box<float>(top), ray.s_min);
  if (!(enter <= bound) || enter == std::numeric_limits<double>::infinity()) return Errc::kOk;
  return BOXTREE_DISPATCH(walk_ray)(top, ray, enter, bound, visit);
}

}  // namespace boxtree
#endif
