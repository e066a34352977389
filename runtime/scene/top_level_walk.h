// SPDX-License-Identifier: MIT
// Finds the instances of a scene that a query may intersect: walks of its top level, whose leaves
// are static ones, and of the tree over moving ones, by vectors if the build has any.
#pragma once

#include <cstdint>

#include <boxtree/error.h>
#include <boxtree/query.h>

#include "runtime/query/ray_slab.h"
#include "runtime/scene/moving_tree.h"
#include "runtime/scene/top_level.h"
#include "runtime/tree/bound_codec.h"

namespace boxtree {

/// Called with the number of an instance, or of a moving one: whether to go on.
using InstanceVisitor = FunctionRef<bool(std::uint32_t)>;

/// A ray in the scene's frame, origin + s * direction; the largest component of the direction is in
/// [1/2, 1).
struct TopLevelRay {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
  double max_abs;  // on every axis, that `slab` was made with
  RaySlab slab;
  double s_min;
  // Half, of the bounds of a shape around its point, by which the slab widens boxes.
  Eigen::Vector3d extent = Eigen::Vector3d::Zero();

  /// What is added to the largest coordinate of a tree by the shape while it is near.
  [[nodiscard]] double near_extent() const noexcept { return 2 * largest_magnitude(extent); }
};

// For TopLevel and MovingTree.

/// The walks one child at a time; see walk_instances.
template <class Tree>
Errc walk_one_by_one(const Tree& tree, const Box<double>& box, InstanceVisitor visit);
template <class Tree>
Errc walk_one_by_one(const Tree& tree, const Eigen::Vector3d& point, const double& bound,
                     InstanceVisitor visit);
template <class Tree>
Errc walk_one_by_one(const Tree& tree, const TopLevelRay& ray, const double& bound,
                     InstanceVisitor visit);

/// The same by vectors, if the build has any.
template <class Tree>
Errc walk_by_vectors(const Tree& tree, const Box<double>& box, InstanceVisitor visit);
template <class Tree>
Errc walk_by_vectors(const Tree& tree, const Eigen::Vector3d& point, const double& bound,
                     InstanceVisitor visit);
template <class Tree>
Errc walk_by_vectors(const Tree& tree, const TopLevelRay& ray, const double& bound,
                     InstanceVisitor visit);

/// Visits all instances of a tree whose boxes intersect the query, and maybe some that only nearly
/// do. `shape`, in the scene's frame: a box; or a point or a ray, and a bound, a squared distance
/// or a parameter: then from near to far. The bound is read again after each visit, which may lower
/// it; instances beyond it are left out, those at it are not. Errors: kNodeCorrupt, kDepthExceeded
/// for corrupt nodes.
template <class Tree, class... Shape>
Errc walk_instances(const Tree& tree, InstanceVisitor visit, const Shape&... shape) {
  if constexpr (kWalksByVectors) {
    return walk_by_vectors(tree, shape..., visit);
  } else {
    return walk_one_by_one(tree, shape..., visit);
  }
}

}  // namespace boxtree
