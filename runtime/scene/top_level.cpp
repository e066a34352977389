// SPDX-License-Identifier: MIT
// Walks of the two trees over the instances of a scene, one child at a time.
#include "runtime/query/relative_pose.h"
#include "runtime/scene/top_level_walk.h"
#include "runtime/walk/traversal.h"

namespace boxtree {
namespace {

// Queries of walk/traversal.h whose leaves are instances.
template <class Tree>
struct Instances {
  Instances(const Tree& walked, InstanceVisitor visitor)
      : tree(walked), visit(visitor), nodes(walked.node_count()) {}

  const Tree& tree;
  InstanceVisitor visit;
  WalkBound nodes;

  [[nodiscard]] bool leaf(NodeRef ref) const { return visit(tree.instance(ref)); }
};

template <class Tree>
struct InstancesInBox : Instances<Tree> {
  const Box<double>& region;

  template <class S>
  [[nodiscard]] bool overlaps(const Box<S>& box) const noexcept {
    return boxes_overlap(box, region);
  }
};

template <class Tree>
struct InstancesNearPoint : Instances<Tree> {
  const Eigen::Vector3d& point;
  const double& best;

  [[nodiscard]] double bound() const noexcept { return best; }
  template <class S>
  [[nodiscard]] double key(const Box<S>& box) const noexcept {
    return squared_distance(point, box);
  }
};

template <class Tree>
struct InstancesOnRay : Instances<Tree> {
  const TopLevelRay& ray;
  const double& s_max;

  [[nodiscard]] double bound() const noexcept { return s_max; }
  template <class S>
  [[nodiscard]] double key(const Box<S>& box) const noexcept {
    return ray.slab.key(box, ray.s_min);
  }
};

}  // namespace

template <class Tree>
Errc walk_one_by_one(const Tree& tree, const Box<double>& box, InstanceVisitor visit) {
  InstancesInBox<Tree> query{{tree, visit}, box};
  return traverse_overlap(tree, tree.decoder(), query);
}

template <class Tree>
Errc walk_one_by_one(const Tree& tree, const Eigen::Vector3d& point, const double& bound,
                     InstanceVisitor visit) {
  InstancesNearPoint<Tree> query{{tree, visit}, point, bound};
  return traverse_nearest(tree, tree.decoder(), query);
}

template <class Tree>
Errc walk_one_by_one(const Tree& tree, const TopLevelRay& ray, const double& bound,
                     InstanceVisitor visit) {
  InstancesOnRay<Tree> query{{tree, visit}, ray, bound};
  return traverse_nearest(tree, tree.decoder(), query);
}

template Errc walk_one_by_one(const TopLevel&, const Box<double>&, InstanceVisitor);
template Errc walk_one_by_one(const TopLevel&, const Eigen::Vector3d&, const double&,
                              InstanceVisitor);
template Errc walk_one_by_one(const TopLevel&, const TopLevelRay&, const double&, InstanceVisitor);
template Errc walk_one_by_one(const MovingTree&, const Box<double>&, InstanceVisitor);
template Errc walk_one_by_one(const MovingTree&, const Eigen::Vector3d&, const double&,
                              InstanceVisitor);
template Errc walk_one_by_one(const MovingTree&, const TopLevelRay&, const double&,
                              InstanceVisitor);

}  // namespace boxtree
