// SPDX-License-Identifier: MIT
// The two trees over the instances of a scene by vectors: which of them a box, a point or a ray may
// intersect.
#include <algorithm>
#include <type_traits>

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
#include "runtime/walk/traversal_stack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR
template <class Tree>
Errc walk_box(const Tree& tree, const Box<double>& box, InstanceVisitor visit) {
  return walk_one_by_one(tree, box, visit);
}
template <class Tree>
Errc walk_point(const Tree& tree, const Eigen::Vector3d& point, const double& bound,
                InstanceVisitor visit) {
  return walk_one_by_one(tree, point, bound, visit);
}
template <class Tree>
Errc walk_ray(const Tree& tree, const TopLevelRay& ray, const RayBoxFilter& /*filter*/,
              const double& bound, InstanceVisitor visit) {
  return walk_one_by_one(tree, ray, bound, visit);
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

// The tree is in private memory and complete: each walk ends.
template <class Region>
Errc walk(const MovingTree& tree, const Region& region, const double& bound,
          InstanceVisitor visit) {
  const Floats d;
  TraversalStack<MovingTree::kMostDepths> stack;
  std::uint32_t first[MovingTree::kMostDepths];  // the node in lane 0, at each depth
  float limit = region.limit_of(bound);
  std::uint32_t node = tree.top_node();
  for (std::size_t depth = 0;;) {
    first[depth] = node;
    const MovingTree::Eight& eight = tree.eight(node, depth);
    HWY_ALIGN float keys[kWideChildren];
    std::uint32_t passing = 0;
    for (std::size_t part = 0; part < kParts; ++part) {
      VectorBox boxes;
      for (std::size_t k = 0; k < 3; ++k) {
        boxes.low[k] = hn::LoadU(d, eight.low[k] + part * kLanes);
        boxes.high[k] = hn::LoadU(d, eight.high[k] + part * kLanes);
      }
      FloatVector key;
      const std::uint32_t there = bits_of(hn::Le(boxes.low[0], boxes.high[0]));
      passing |= (region.intersect(boxes, limit, key) & there) << (part * kLanes);
      hn::Store(key, d, keys + part * kLanes);
    }
    stack.push(passing, keys, depth);
    for (;;) {
      typename decltype(stack)::Child at;
      if (!stack.pop(limit, at)) return Errc::kOk;
      node = first[at.depth] + at.number;
      depth = at.depth + 1;
      if (depth < tree.depths()) break;
      if (!visit(tree.instance({node, 0}))) return Errc::kOk;
      limit = region.limit_of(bound);
    }
    node *= kWideChildren;
  }
}

// Whether this instruction set has a walk of its own of such a tree.
template <class Tree>
constexpr bool kIsWalked = std::is_same_v<Tree, TopLevel> || BOXTREE_HAS_SPECIAL_WALKS;

template <class Tree>
Errc walk_box(const Tree& tree, const Box<double>& box, InstanceVisitor visit) {
  if constexpr (kIsWalked<Tree>) {
    BoxRegion region;
    for (std::size_t k = 0; k < 3; ++k) region.bounds.set(k, box.low[k], box.high[k], 0);
    return walk(tree, region, 0, visit);
  } else {
    return walk_one_by_one(tree, box, visit);
  }
}

template <class Tree>
Errc walk_point(const Tree& tree, const Eigen::Vector3d& point, const double& bound,
                InstanceVisitor visit) {
  if constexpr (kIsWalked<Tree>) {
    return walk(tree, PointRegion{PointFilter(max_abs_of(tree), point)}, bound, visit);
  } else {
    return walk_one_by_one(tree, point, bound, visit);
  }
}

template <class Tree>
Errc walk_ray(const Tree& tree, [[maybe_unused]] const TopLevelRay& ray, const RayBoxFilter& filter,
              const double& bound, InstanceVisitor visit) {
  if constexpr (kIsWalked<Tree>) {
    return walk(tree, RayRegion{filter}, bound, visit);
  } else {
    return walk_one_by_one(tree, ray, bound, visit);
  }
}
#endif

Errc walk_top_box(const TopLevel& top, const Box<double>& box, InstanceVisitor visit) {
  return walk_box(top, box, visit);
}
Errc walk_top_point(const TopLevel& top, const Eigen::Vector3d& point, const double& bound,
                    InstanceVisitor visit) {
  return walk_point(top, point, bound, visit);
}
Errc walk_top_ray(const TopLevel& top, const TopLevelRay& ray, const RayBoxFilter& filter,
                  const double& bound, InstanceVisitor visit) {
  return walk_ray(top, ray, filter, bound, visit);
}

Errc walk_moving_box(const MovingTree& tree, const Box<double>& box, InstanceVisitor visit) {
  return walk_box(tree, box, visit);
}
Errc walk_moving_point(const MovingTree& tree, const Eigen::Vector3d& point, const double& bound,
                       InstanceVisitor visit) {
  return walk_point(tree, point, bound, visit);
}
Errc walk_moving_ray(const MovingTree& tree, const TopLevelRay& ray, const RayBoxFilter& filter,
                     const double& bound, InstanceVisitor visit) {
  return walk_ray(tree, ray, filter, bound, visit);
}

}  // namespace
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "runtime/walk/dispatch.h"

namespace boxtree {
namespace {

BOXTREE_EXPORT(walk_top_box);
BOXTREE_EXPORT(walk_top_point);
BOXTREE_EXPORT(walk_top_ray);
BOXTREE_EXPORT(walk_moving_box);
BOXTREE_EXPORT(walk_moving_point);
BOXTREE_EXPORT(walk_moving_ray);

template <class Tree>
constexpr bool kIsTop = std::is_same_v<Tree, TopLevel>;

// What walks by vectors are told of a tree.
struct FloatTree {
  template <class Tree>
  explicit FloatTree(const Tree& tree) : root(root_box<double>(tree)), max_abs(max_abs_of(tree)) {}

  Box<double> root;
  double max_abs;
};

// Whether a ray is compared with boxes in single precision, and may meet some.
enum class Meeting { kNone, kByVectors, kOneByOne };

// `filter`: set for kByVectors.
Meeting prepare(const FloatTree& tree, const TopLevelRay& ray, double bound, RayBoxFilter& filter) {
  // A shape may be so large beside the tree that its size takes the digits; an ill-conditioned map
  // may widen the query by more than the tree's size; the filter is then useless.
  const double origin_max_abs = largest_magnitude(ray.origin);
  const double near = tree.max_abs + ray.near_extent();
  const double given_away = RayBoxFilter::given_away(origin_max_abs, ray.max_abs);
  const bool is_near = origin_max_abs <= 0x1p30 * tree.max_abs && near <= 0x1p10 * tree.max_abs &&
                       given_away <= tree.max_abs;
  if (!is_near) return Meeting::kOneByOne;
  const double enter = ray.slab.key(tree.root, ray.s_min);
  if (!(enter <= bound) || enter == std::numeric_limits<double>::infinity()) return Meeting::kNone;
  filter = RayBoxFilter(ray.slab, AxisLanes(ray.origin), AxisLanes(ray.direction),
                        std::max(enter, ray.s_min), RayBoxFilter::rounding(near) + given_away);
  filter.widen(ray.extent);
  return Meeting::kByVectors;
}

}  // namespace

template <class Tree>
Errc walk_by_vectors(const Tree& tree, const Box<double>& box, InstanceVisitor visit) {
  if (!tree.has_float_nodes()) return walk_one_by_one(tree, box, visit);
  if constexpr (kIsTop<Tree>) {
    return BOXTREE_DISPATCH(walk_top_box)(tree, box, visit);
  } else {
    return BOXTREE_DISPATCH(walk_moving_box)(tree, box, visit);
  }
}

template <class Tree>
Errc walk_by_vectors(const Tree& tree, const Eigen::Vector3d& point, const double& bound,
                     InstanceVisitor visit) {
  if (!tree.has_float_nodes() || !PointFilter::is_near(max_abs_of(tree), point)) {
    return walk_one_by_one(tree, point, bound, visit);
  }
  if constexpr (kIsTop<Tree>) {
    return BOXTREE_DISPATCH(walk_top_point)(tree, point, bound, visit);
  } else {
    return BOXTREE_DISPATCH(walk_moving_point)(tree, point, bound, visit);
  }
}

template <class Tree>
Errc walk_by_vectors(const Tree& tree, const TopLevelRay& ray, const double& bound,
                     InstanceVisitor visit) {
  RayBoxFilter filter;
  const Meeting meeting =
      tree.has_float_nodes() ? prepare(FloatTree(tree), ray, bound, filter) : Meeting::kOneByOne;
  if (meeting == Meeting::kNone) return Errc::kOk;
  if (meeting == Meeting::kOneByOne) return walk_one_by_one(tree, ray, bound, visit);
  if constexpr (kIsTop<Tree>) {
    return BOXTREE_DISPATCH(walk_top_ray)(tree, ray, filter, bound, visit);
  } else {
    return BOXTREE_DISPATCH(walk_moving_ray)(tree, ray, filter, bound, visit);
  }
}

template Errc walk_by_vectors(const TopLevel&, const Box<double>&, InstanceVisitor);
template Errc walk_by_vectors(const TopLevel&, const Eigen::Vector3d&, const double&,
                              InstanceVisitor);
template Errc walk_by_vectors(const TopLevel&, const TopLevelRay&, const double&, InstanceVisitor);
template Errc walk_by_vectors(const MovingTree&, const Box<double>&, InstanceVisitor);
template Errc walk_by_vectors(const MovingTree&, const Eigen::Vector3d&, const double&,
                              InstanceVisitor);
template Errc walk_by_vectors(const MovingTree&, const TopLevelRay&, const double&,
                              InstanceVisitor);

}  // namespace boxtree
#endif
