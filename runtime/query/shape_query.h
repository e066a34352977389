// SPDX-License-Identifier: MIT
// The shapes that overlap queries ask about: a monotone test of boxes and the exact test of
// triangles, both in tree space.
#pragma once

#include <boxtree/runtime/primitive/predicates.h>
#include <boxtree/runtime/query/traversal.h>

namespace boxtree {

struct BoxQuery {
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

struct SphereQuery {
  Eigen::Vector3d center;  // tree space
  double squared_radius;

  template <class S>
  [[nodiscard]] bool overlaps(const Box<S>& box) const noexcept {
    return squared_distance(center, box) <= squared_radius;
  }
  [[nodiscard]] bool touches(const Triangle& triangle) const noexcept {
    return (closest_point_on_triangle(center, triangle) - center).squaredNorm() <= squared_radius;
  }
};

}  // namespace boxtree
