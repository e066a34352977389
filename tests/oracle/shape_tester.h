// SPDX-License-Identifier: MIT
// What each library answers for a triangle and a convex shape.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <boxtree/shape.h>

#include "runtime/primitive/triangle.h"

namespace boxtree::test {

/// A shape that touches a triangle or does not: the points whose hull, with a radius around it, it
/// is. `kind`: 0 a sphere, 1 a capsule, 2 a box along the axes, 3 a hull.
struct TestedShape {
  int kind = 0;
  std::vector<Eigen::Vector3d> points;  // a center, two ends, eight corners, any
  double radius = 0;
};
inline constexpr const char* kShapeNames[] = {"sphere", "capsule", "box", "hull"};

/// Whether they share a point, as one library says. Coordinates are floats.
struct ShapeTester {
  std::string library;
  std::string variant;
  std::function<bool(const Triangle&, const TestedShape&)> touch;
};

// Each library adds its own; those that are not installed are not compiled.
void add_boxtree_testers(std::vector<ShapeTester>& testers);
void add_fcl_testers(std::vector<ShapeTester>& testers);

}  // namespace boxtree::test
