// SPDX-License-Identifier: MIT
// The top level of a scene by vectors: which instances a box, a point or a ray may meet.
#include <algorithm>

#include <boxtree/runtime/query/relative_pose.h>
#include <boxtree/runtime/scene/top_level_walk.h>
#include <boxtree/runtime/wide/point_filter.h>
#include <boxtree/runtime/wide/ray_filter.h>
#include <boxtree/runtime/wide/targets.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "boxtree/runtime/wide/top_level.cpp"
#include <hwy/foreach_target.h>
// Highway's headers must come after foreach_target.h.
#include <hwy/highway.h>

#include <boxtree/runtime/wide/box_bounds-inl.h>
#include <boxtree/runtime/wide/distance-inl.h>
#include <boxtree/runtime/wide/nearest-inl.h>

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR
Errc walk_box(const TopLevel& top, const Box<double>& box, InstanceVisitor visit) {
  return walk_top_level_plainly(top, box, visit);
}
Errc walk_point(const TopLevel& top, const Eigen::Vector3d& point, const double& bound,
                InstanceVisitor visit) {
  return walk_top_level_plainly(top, point, bound, visit);
}
Errc walk_ray(const TopLevel& top, const TopLevelRay& ray, double /*enter*/, const double& bound,
              InstanceVisitor visit) {
  return walk_top_level_plainly(top, ray, bound, visit);
}
#else
// Queries of NearestWalk.
struct Instances {
  InstanceVisitor visit;

  void expanding(const WideLinks& /*links*/, std::uint32_t /*passing*/) const {}
  bool leaf(std::uint32_t number) const { return visit(number); }
};

// All keys are alike: in no promised order.
struct InstancesInBox : Instances {
  BoxBounds asked;

  [[nodiscard]] float bound() const { return 0; }
  HWY_INLINE std::uint32_t meet(const VectorBox& boxes, FloatVector& key) const {
    key = hn::Zero(Floats());
    return asked.judge(boxes).touched;
  }
};

struct InstancesNearPoint : Instances {
  const PointFilter& point;
  const double& best;
  float limit;  // of keys, by `best`

  [[nodiscard]] float bound() const { return limit; }
  bool leaf(std::uint32_t number) {
    const bool go_on = visit(number);
    limit = PointFilter::above(best);
    return go_on;
  }
  HWY_INLINE std::uint32_t meet(const VectorBox& boxes, FloatVector& key) const {
    key = nearest_squared(point, boxes);
    return bits_of(hn::Le(key, hn::Set(Floats(), bound())));
  }
};

struct InstancesOnRay : Instances {
  const RayBoxFilter& ray;
  const double& s_max;
  float limit;  // of keys, by `s_max`

  [[nodiscard]] float bound() const { return limit; }
  bool leaf(std::uint32_t number) {
    const bool go_on = visit(number);
    limit = ray.bound(s_max);
    return go_on;
  }
  HWY_INLINE std::uint32_t meet(const VectorBox& boxes, FloatVector& key) const {
    const Floats d;
    FloatVector leave = hn::Set(d, bound());
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

template <class Query>
Errc walk(const TopLevel& top, Query& query) {
  return NearestWalk<Wide8Node, Query>(top.codec, query).run(root_box<float>(top));
}

Errc walk_box(const TopLevel& top, const Box<double>& box, InstanceVisitor visit) {
  InstancesInBox query{{visit}, {}};
  for (std::size_t k = 0; k < 3; ++k) query.asked.set(k, box.low[k], box.high[k], 0);
  return walk(top, query);
}

Errc walk_point(const TopLevel& top, const Eigen::Vector3d& point, const double& bound,
                InstanceVisitor visit) {
  const PointFilter filter(reach_of(top), point);
  InstancesNearPoint query{{visit}, filter, bound, PointFilter::above(bound)};
  return walk(top, query);
}

Errc walk_ray(const TopLevel& top, const TopLevelRay& ray, double enter, const double& bound,
              InstanceVisitor visit) {
  const RayBoxFilter filter(
      ray.slab, ray.origin, ray.direction, std::max(enter, ray.s_min),
      RayBoxFilter::rounding(reach_of(top)) + RayBoxFilter::given_away(ray.origin, ray.reach));
  InstancesOnRay query{{visit}, filter, bound, filter.bound(bound)};
  return walk(top, query);
}
#endif

}  // namespace
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxtree {
namespace {

HWY_EXPORT(walk_box);
HWY_EXPORT(walk_point);
HWY_EXPORT(walk_ray);

}  // namespace

Errc walk_wide(const TopLevel& top, const Box<double>& box, InstanceVisitor visit) {
  if (!top.has_nodes()) return walk_top_level_plainly(top, box, visit);
  if (!boxes_overlap(root_box<float>(top), box)) return Errc::kOk;
  return HWY_DYNAMIC_DISPATCH(walk_box)(top, box, visit);
}

Errc walk_wide(const TopLevel& top, const Eigen::Vector3d& point, const double& bound,
               InstanceVisitor visit) {
  if (!top.has_nodes() || !PointFilter::is_near(reach_of(top), point)) {
    return walk_top_level_plainly(top, point, bound, visit);
  }
  if (squared_distance(point, root_box<float>(top)) > bound) return Errc::kOk;
  return HWY_DYNAMIC_DISPATCH(walk_point)(top, point, bound, visit);
}

Errc walk_wide(const TopLevel& top, const TopLevelRay& ray, const double& bound,
               InstanceVisitor visit) {
  const double reach = reach_of(top);
  // Where a map that is hard to undo makes the query give away more, its margin alone is what
  // decides.
  const bool is_near = ray.origin.cwiseAbs().maxCoeff() <= 0x1p30 * reach &&
                       RayBoxFilter::given_away(ray.origin, ray.reach) <= reach;
  if (!top.has_nodes() || !is_near) return walk_top_level_plainly(top, ray, bound, visit);
  const double enter = ray.slab.key(root_box<float>(top), ray.s_min);
  if (!(enter <= bound) || enter == std::numeric_limits<double>::infinity()) return Errc::kOk;
  return HWY_DYNAMIC_DISPATCH(walk_ray)(top, ray, enter, bound, visit);
}

}  // namespace boxtree
#endif
