// SPDX-License-Identifier: MIT
// Frustums in extended precision, and cameras.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <boxtree/overlap.h>

#include "tests/support/scenes.h"
#include "tests/support/shape_reference.h"

namespace boxtree::test {

// Whether anything is left of a triangle, when each plane is moved out by `widened` of the largest
// value that its sum may have.
inline bool touches(const Frustum& frustum, const LongTriangle& triangle, long double size,
                    long double widened) {
  std::vector<LongVector> left(triangle.begin(), triangle.end());
  for (const Frustum::Plane& plane : frustum.planes) {
    const LongVector normal = plane.head<3>().cast<long double>();
    const long double offset =
        plane[3] + widened * (normal.lpNorm<1>() * size + std::abs(plane[3]));
    std::vector<LongVector> kept;
    for (std::size_t i = 0; i < left.size(); ++i) {
      const LongVector& a = left[i];
      const LongVector& b = left[(i + 1) % left.size()];
      const long double of_a = normal.dot(a) + offset, of_b = normal.dot(b) + offset;
      if (of_a >= 0) kept.push_back(a);
      if ((of_a >= 0) != (of_b >= 0)) kept.push_back(a + of_a / (of_a - of_b) * (b - a));
    }
    left = kept;
  }
  return !left.empty();
}

// Of a camera, as engines compute it.
inline Frustum::ViewProjection view_projection(const Eigen::Vector3d& eye,
                                               const Eigen::Vector3d& target, double field_of_view,
                                               double near, double far) {
  const Eigen::Vector3d back = (eye - target).normalized();
  const Eigen::Vector3d right = Eigen::Vector3d(0.1, 1, 0.2).cross(back).normalized();
  Frustum::ViewProjection view = Frustum::ViewProjection::Identity();
  view.block<1, 3>(0, 0) = right.transpose();
  view.block<1, 3>(1, 0) = back.cross(right).transpose();
  view.block<1, 3>(2, 0) = back.transpose();
  view.block<3, 1>(0, 3) = -(view.block<3, 3>(0, 0) * eye);
  const double zoom = 1 / std::tan(field_of_view / 2);
  Frustum::ViewProjection projection = Frustum::ViewProjection::Zero();
  projection.diagonal() << zoom / 1.5, zoom, far / (near - far), 0;
  projection(2, 3) = near * far / (near - far);
  projection(3, 2) = -1;
  return projection * view;
}

// The largest one of a world.
inline double largest_coordinate(const std::vector<WorldTriangle>& triangles) {
  double largest = 0;
  for (const WorldTriangle& each : triangles) {
    for (const Eigen::Vector3d& corner : each.triangle.corner) {
      largest = std::max(largest, corner.cwiseAbs().maxCoeff());
    }
  }
  return largest;
}

}  // namespace boxtree::test
