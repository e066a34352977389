// SPDX-License-Identifier: MIT
// The rare part of the watertight ray test: areas that round to zero or are small.
#include "runtime/primitive/triangle_ray.h"

#include <algorithm>
#include <cmath>

#include "runtime/primitive/expansion.h"

namespace boxtree {
namespace {

double exact_area(double scale, const ShearedCorner& from, const ShearedCorner& to) {
  return (exact_product(scale * from.x, scale * to.y) - exact_product(scale * from.y, scale * to.x))
      .estimate();
}

}  // namespace

RayEdges exact_ray_edges(const ShearedCorner& a, const ShearedCorner& b,
                         const ShearedCorner& c) noexcept {
  // One scale for all three: only their ratios matter.
  const double scale = safe_scale(std::max(
      {std::abs(a.x), std::abs(a.y), std::abs(b.x), std::abs(b.y), std::abs(c.x), std::abs(c.y)}));
  const RayEdges edges{exact_area(scale, c, b), exact_area(scale, a, c), exact_area(scale, b, a)};
  return edges.has_mixed_signs() ? RayEdges{} : edges;
}

// The axes of the ray are those of space in turn, so that corners that are counterclockwise from
// where the ray comes from are clockwise in x and y where z ascends along it. The edges' areas are
// those of corners in the other order.
bool meets_front(const RayShear& ray, const Triangle& triangle) noexcept {
  const RayEdges edges =
      exact_ray_edges(ray.sheared(triangle.corner[0]), ray.sheared(triangle.corner[1]),
                      ray.sheared(triangle.corner[2]));
  // All signs agree, or are zero.
  const bool is_positive = edges.opposite0 > 0 || edges.opposite1 > 0 || edges.opposite2 > 0;
  return is_positive == (ray.shear_z > 0);
}

}  // namespace boxtree
