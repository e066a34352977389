// SPDX-License-Identifier: MIT
// A caller's shape in tree space, checked.
#pragma once

#include <boxtree/shape.h>

#include "runtime/primitive/convex_shape.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree {

/// A shape in tree space, but for its center.
struct ShapeInTree {
  ConvexShape shape;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  // object space
  const char* invalid = nullptr;  // the name of a field that is not valid; then the rest is not
};

[[nodiscard]] ShapeInTree in_tree(const BoundTree& tree, const Sphere& sphere) noexcept;
[[nodiscard]] ShapeInTree in_tree(const BoundTree& tree, const Capsule& capsule) noexcept;
[[nodiscard]] ShapeInTree in_tree(const BoundTree& tree, const OrientedBox& box) noexcept;

}  // namespace boxtree
