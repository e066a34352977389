// SPDX-License-Identifier: MIT
// Walks of the top level of a scene, one child at a time.
#include "runtime/query/relative_pose.h"
#include "runtime/scene/top_level_walk.h"
#include "runtime/walk/traversal.h"

namespace boxtree {
namespace {

// Queries of walk/traversal.h whose leaves are instances.
struct Instances {
  Instances(const TopLevel& level, InstanceVisitor visitor)
      : top(level), visit(visitor), nodes(level.scene.node_count) {}

  const TopLevel& top;
  InstanceVisitor visit;
  WalkBound nodes;

  [[nodiscard]] bool leaf(NodeRef ref) const { return visit(top.instance(ref)); }
};

struct InstancesInBox : Instances {
  const Box<double>& region;

  template <class S>
  [[nodiscard]] bool overlaps(const Box<S>& box) const noexcept {
    return boxes_overlap(box, region);
  }
};

struct InstancesNearPoint : Instances {
  const Eigen::Vector3d& point;
  const double& best;

  [[nodiscard]] double bound() const noexcept { return best; }
  template <class S>
  [[nodiscard]] double key(const Box<S>& box) const noexcept {
    return squared_distance(point, box);
  }
};

struct InstancesOnRay : Instances {
  const TopLevelRay& ray;
  const double& s_max;

  [[nodiscard]] double bound() const noexcept { return s_max; }
  template <class S>
  [[nodiscard]] double key(const Box<S>& box) const noexcept {
    return ray.slab.key(box, ray.s_min);
  }
};

}  // namespace

Errc walk_top_level_scalar(const TopLevel& top, const Box<double>& box, InstanceVisitor visit) {
  InstancesInBox query{{top, visit}, box};
  return traverse_overlap(top, top.codec, query);
}

Errc walk_top_level_scalar(const TopLevel& top, const Eigen::Vector3d& point, const double& bound,
                           InstanceVisitor visit) {
  InstancesNearPoint query{{top, visit}, point, bound};
  return traverse_nearest(top, top.codec, query);
}

Errc walk_top_level_scalar(const TopLevel& top, const TopLevelRay& ray, const double& bound,
                           InstanceVisitor visit) {
  InstancesOnRay query{{top, visit}, ray, bound};
  return traverse_nearest(top, top.codec, query);
}

}  // namespace boxtree
