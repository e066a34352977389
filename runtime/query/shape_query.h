// SPDX-License-Identifier: MIT
// The shapes of overlap queries: a monotone test of boxes and the exact test of
// triangles, both in tree space; and what receives the faces.
#pragma once

#include <boxtree/shape.h>

#include "runtime/primitive/predicates.h"
#include "runtime/primitive/vector3.h"
#include "runtime/query/point_filter.h"
#include "runtime/query/relative_pose.h"
#include "runtime/tree/bound_tree.h"
#include "runtime/walk/face_visit.h"
#include "runtime/walk/traversal.h"
#include "runtime/walk/work.h"

namespace boxtree {

struct BoxQuery {
  using Visitor = FaceVisitor;

  Eigen::Vector3d low;  // tree space
  Eigen::Vector3d high;

  // Comparisons only: exact, closed, monotone.
  template <class S>
  [[nodiscard]] bool overlaps(const Box<S>& box) const noexcept {
    bool apart = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      apart |= box.low[k] > high[axis] || box.high[k] < low[axis];
    }
    return !apart;
  }
  [[nodiscard]] bool touches(const Triangle& triangle) const noexcept {
    return triangle_intersects_box(triangle, low, high);
  }
};

/// A sphere of the world, for the exact test of placed triangles.
struct PlacedSphere {
  AffineMap to_world;  // from tree space
  Eigen::Vector3d center;
  double squared_radius;

  [[nodiscard]] bool touches(const Triangle& triangle) const noexcept {
    const Eigen::Vector3d closest = closest_point_on_triangle(center, to_world.apply(triangle));
    return squared_length(closest - center) <= squared_radius;
  }
};

struct SphereQuery {
  using Visitor = FaceVisitor;

  Eigen::Vector3d center;  // tree space
  double squared_radius;
  /// For a placed tree: the exact test is done in the world. In tree space, all that may touch is
  /// then within the radius above; what is within the radius below touches without a test.
  const PlacedSphere* placed = nullptr;
  double certain_squared_radius = squared_radius;

  template <class S>
  [[nodiscard]] bool overlaps(const Box<S>& box) const noexcept {
    return squared_distance(center, box) <= squared_radius;
  }
  [[nodiscard]] bool touches(const Triangle& triangle) const noexcept {
    if (placed != nullptr) return placed->touches(triangle);
    return squared_length(closest_point_on_triangle(center, triangle) - center) <= squared_radius;
  }
};

/// A shape of a caller in tree space.
template <class Shape>
struct QueriedShape {
  const char* invalid = nullptr;  ///< The argument that is not valid; then there is no shape.
  Shape shape{};
};
[[nodiscard]] QueriedShape<BoxQuery> in_tree_space(const BoundTree& tree,
                                                   const Eigen::AlignedBox3d& box) noexcept;
[[nodiscard]] QueriedShape<SphereQuery> in_tree_space(const BoundTree& tree,
                                                      const Sphere& sphere) noexcept;

/// Whether single precision resolves the parts of a tree from a shape, so that it is worth a walk
/// by vectors.
[[nodiscard]] inline bool is_near(const BoundTree& /*tree*/, const BoxQuery& /*box*/) noexcept {
  return true;
}
[[nodiscard]] inline bool is_near(const BoundTree& tree, const SphereQuery& sphere) noexcept {
  return PointFilter::is_near(tree.largest_abs(), sphere.center);
}

/// By vectors; see walk_tree.h.
Errc walk_wide(const BoundTree& tree, FaceWalk<BoxQuery>& walk);
Errc walk_wide(const BoundTree& tree, FaceWalk<SphereQuery>& walk);

/// overlap_sphere for callers that have made the shape themselves.
Result<Visit> visit_sphere(const BoundTree& tree, const SphereQuery& sphere, FaceVisitor visitor,
                           QueryWork& work);

}  // namespace boxtree
