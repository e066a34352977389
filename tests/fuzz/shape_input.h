// SPDX-License-Identifier: MIT
// The shape of a query: any sphere, capsule, box or hull.
#pragma once

#include <array>
#include <span>

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
      const std::array<Eigen::Vector3d, 5> points{extent, Eigen::Vector3d::Zero(),
                                                  Eigen::Vector3d(size, 0, 0), -extent, extent};
      ConvexHull hull{
          std::span(points).first(1 + query.option(4) % points.size()), at, {1, 0, 0, 0}};
      if (query.option(4) % 2 == 1) hull.rotation = {size, extent[0], extent[1], extent[2]};
      return body(hull);
  }
}

}  // namespace boxtree::fuzz
