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

// From near to far. Keys are computed by a function, so that all shapes share a walk.
template <class Tree>
struct InstancesByKey : Instances<Tree> {
  FunctionRef<double(const Box<double>&)> key_of;
  const double& best;

  [[nodiscard]] double bound() const noexcept { return best; }
  template <class S>
  [[nodiscard]] double key(const Box<S>& box) const {
    return key_of(box_cast<double>(box));
  }
};

template <class Tree>
Errc walk_near(const Tree& tree, FunctionRef<double(const Box<double>&)> key, const double& bound,
               InstanceVisitor visit) {
  InstancesByKey<Tree> query{{tree, visit}, key, bound};
  return traverse_nearest(tree, tree.decoder(), query);
}

}  // namespace

template <class Tree>
Errc walk_one_by_one(const Tree& tree, const Box<double>& box, InstanceVisitor visit) {
  InstancesInBox<Tree> query{{tree, visit}, box};
  return traverse_overlap(tree, tree.decoder(), query);
}

template <class Tree>
Errc walk_one_by_one(const Tree& tree, const Eigen::Vector3d& point, const double& bound,
                     InstanceVisitor visit) {
  const auto key = [&](const Box<double>& box) { return squared_distance(point, box); };
  return walk_near(tree, key, bound, visit);
}

template <class Tree>
Errc walk_one_by_one(const Tree& tree, const TopLevelRay& ray, const double& bound,
                     InstanceVisitor visit) {
  const auto key = [&](const Box<double>& box) { return ray.slab.key(box, ray.s_min); };
  return walk_near(tree, key, bound, visit);
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
