// SPDX-License-Identifier: MIT
// The convex hull of points in tree space, or in units of a scene.
#pragma once

#include <array>

#include <boxtree/shape.h>

#include "runtime/primitive/convex_points.h"
#include "runtime/primitive/float_state.h"
#include "runtime/query/shape_in_tree.h"

namespace boxtree {

/// A hull in tree space, but for its center: the middle of its bounds along its own axes. Keeps
/// its points, and the default state of floating point as long as it lives.
class HullInTree {
 public:
  HullInTree(const Frame& frame, const ConvexHull& hull) noexcept;
  HullInTree(const HullInTree&) = delete;
  HullInTree& operator=(const HullInTree&) = delete;
  ~HullInTree() = default;

  [[nodiscard]] const ShapeInTree& shape() const noexcept { return shape_; }

 private:
  const DefaultFloatState state_;
  ShapeInTree shape_;
  std::array<Eigen::Vector3d, kMaxHullPoints> points_;
  ConvexPoints points_of_shape_{{}, hull_distance, hull_penetration};
};

}  // namespace boxtree
