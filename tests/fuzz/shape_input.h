// SPDX-License-Identifier: MIT
// The shape of a query: any sphere, capsule or box.
#pragma once

#include <boxtree/boxtree.h>

#include "tests/fuzz/query_input.h"

namespace boxtree::fuzz {

/// Calls body(shape).
template <class Body>
void with_shape(const QueryInput& query, const Body& body) {
  const Eigen::Vector3d at = query.vector(0);
  const double size = query.number(7);
  const Eigen::Vector3d extent = query.vector(8);
  switch (query.option(2) % 3) {
    case 0:
      return body(Sphere{at, size});
    case 1:
      return body(Capsule{at, at + extent, size});
    default:
      OrientedBox box{at, extent, {1, 0, 0, 0}};
      if (query.option(4) % 2 == 1) box.rotation = {size, extent[0], extent[1], extent[2]};
      return body(box);
  }
}

}  // namespace boxtree::fuzz
