// SPDX-License-Identifier: MIT
// The shape of a query: any sphere, capsule, box or hull.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <boxtree/boxtree.h>

#include "tests/fuzz/query_input.h"

namespace boxtree::fuzz {

/// Calls body(shape).
template <class Body>
void with_shape(const QueryInput& query, const Body& body) {
  const Eigen::Vector3d at = query.vector(0);
  const double size = query.number(7);
  const Eigen::Vector3d extent = query.vector(8);
  switch (query.option(2) % 4) {
    case 0:
      return body(Sphere{at, size});
    case 1:
      return body(Capsule{at, at + extent, size});
    case 2: {
      OrientedBox box{at, extent, {1, 0, 0, 0}};
      if (query.option(4) % 2 == 1) box.rotation = {size, extent[0], extent[1], extent[2]};
      return body(box);
    }
    default:
      // None, a few, the same one often, and more than are allowed.
      constexpr std::array<std::size_t, 8> kCounts{
          0, 1, 2, 3, 4, 5, kMaxHullPoints, kMaxHullPoints + 1};
      const std::array<Eigen::Vector3d, 5> few{
          extent, Eigen::Vector3d::Zero(), Eigen::Vector3d(size, 0, 0), -extent, query.vector(6)};
      std::vector<Eigen::Vector3d> points;
      for (std::size_t i = 0; i < kCounts[query.option(4) / 2 % kCounts.size()]; ++i) {
        const double growth = query.option(7) % 2 == 0 ? 0 : 0x1p-8 * static_cast<double>(i);
        points.emplace_back(few[i % few.size()] * (1 + growth));
      }
      ConvexHull hull{points, at, {1, 0, 0, 0}};
      if (query.option(4) % 2 == 1) hull.rotation = {size, extent[0], extent[1], extent[2]};
      return body(hull);
  }
}

/// Visits the faces of a tree or a scene that a shape touches. `options`: limits, of a scene after
/// layers.
template <class Where, class Visitor, class... Options>
Result<Visit> overlap(const Where& where, const Sphere& shape, const Visitor& visitor,
                      const Options&... options) {
  return overlap_sphere(where, shape.center, shape.radius, visitor, options...);
}
template <class Where, class Visitor, class... Options>
Result<Visit> overlap(const Where& where, const Capsule& shape, const Visitor& visitor,
                      const Options&... options) {
  return overlap_capsule(where, shape, visitor, options...);
}
template <class Where, class Visitor, class... Options>
Result<Visit> overlap(const Where& where, const OrientedBox& shape, const Visitor& visitor,
                      const Options&... options) {
  return overlap_oriented_box(where, shape, visitor, options...);
}
template <class Where, class Visitor, class... Options>
Result<Visit> overlap(const Where& where, const ConvexHull& shape, const Visitor& visitor,
                      const Options&... options) {
  return overlap_convex_hull(where, shape, visitor, options...);
}

}  // namespace boxtree::fuzz
