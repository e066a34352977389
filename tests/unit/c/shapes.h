// SPDX-License-Identifier: MIT
// Shapes of every kind, said to both interfaces.
#pragma once

#include <array>
#include <boxtree_c.h>
#include <cmath>
#include <vector>

#include <boxtree/boxtree.h>

#include "tests/unit/c/subjects.h"

namespace boxtree::test {

[[nodiscard]] inline bxt_quaternion quaternion_of(
    const Eigen::Quaternion<double, Eigen::DontAlign>& q) {
  return {q.x(), q.y(), q.z(), q.w()};
}

/// Calls `body(shape of C, shape of C++)` for shapes of every kind around a point, also some that
/// are not valid.
template <class Body>
void for_each_shape(Randoms& randoms, double size, const Body& body) {
  for (const double radius : {0.05 * size, 0.15 * size, 0.0, -1.0}) {
    const Eigen::Vector3d at = randoms.point(1.2), to = at + 0.2 * (randoms.point() - at);
    const bxt_vec3 c_at = vec3(at), c_to = vec3(to);
    const Eigen::Quaternion<double, Eigen::DontAlign> turn(randoms.unit(), randoms.unit(),
                                                           randoms.unit(), randoms.unit());
    body(bxt_sphere(c_at, radius), Sphere{at, radius});
    body(bxt_capsule(c_at, c_to, radius), Capsule{at, to, radius});
    const Eigen::Vector3d half = radius * Eigen::Vector3d(1, 0.5, 2);
    body(bxt_box(c_at, vec3(half), quaternion_of(turn)), OrientedBox{at, half, turn});
    body(bxt_box(c_at, vec3(half), bxt_no_rotation()), OrientedBox{at, half});
    std::vector<Eigen::Vector3d> points;
    std::vector<bxt_vec3> c_points;
    for (int i = 0; i < 9; ++i) {
      points.push_back(std::abs(radius) *
                       Eigen::Vector3d{randoms.unit(), randoms.unit(), randoms.unit()});
      c_points.push_back(vec3(points.back()));
    }
    if (radius < 0) {
      points[3][1] = NAN;
      c_points[3].y = NAN;
    }
    body(bxt_convex_hull(c_points.data(), c_points.size(), c_at, quaternion_of(turn)),
         ConvexHull{points, at, turn});
  }
}

}  // namespace boxtree::test
