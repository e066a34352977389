// SPDX-License-Identifier: MIT
// A caller's shape in tree space, or in units of a scene, checked.
#pragma once

#include <boxtree/shape.h>

#include "runtime/primitive/convex_shape.h"
#include "runtime/tree/frame.h"

namespace boxtree {

/// A shape in tree space, but for its center.
struct ShapeInTree {
  ConvexShape shape;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  // object space
  const char* invalid = nullptr;  // the name of a field that is not valid; then the rest is not
};

/// `frame`: of the tree.
[[nodiscard]] ShapeInTree in_tree(const Frame& frame, const Sphere& sphere) noexcept;
[[nodiscard]] ShapeInTree in_tree(const Frame& frame, const Capsule& capsule) noexcept;
[[nodiscard]] ShapeInTree in_tree(const Frame& frame, const OrientedBox& box) noexcept;

}  // namespace boxtree
