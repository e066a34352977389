// SPDX-License-Identifier: MIT
// The rare parts of the watertight ray test: setting up the ray, and areas that round to zero.
#include "runtime/primitive/triangle_ray.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/primitive/expansion.h"

namespace boxtree {
namespace {

double exact_area(double scale, const ShearedCorner& from, const ShearedCorner& to) {
  return (exact_product(scale * from.x, scale * to.y) - exact_product(scale * from.y, scale * to.x))
      .estimate();
}

}  // namespace

RayShear::RayShear(const Eigen::Vector3d& ray_origin, const Eigen::Vector3d& direction) noexcept
    : origin(ray_origin) {
  axis_z = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::abs(direction[k]) > std::abs(direction[axis_z])) axis_z = k;
  }
  axis_x = axis_z == 2 ? 0 : axis_z + 1;
  axis_y = axis_z == 0 ? 2 : axis_z - 1;
  shear_x = direction[axis_x] / direction[axis_z];
  shear_y = direction[axis_y] / direction[axis_z];
  // Finite even for a subnormal direction, so that a hit at the origin gets t = 0, not NaN.
  constexpr double kLargest = std::numeric_limits<double>::max();
  shear_z = std::clamp(1 / direction[axis_z], -kLargest, kLargest);
}

RayEdges exact_ray_edges(const ShearedCorner& a, const ShearedCorner& b,
                         const ShearedCorner& c) noexcept {
  // One scale for all three: only their ratios matter.
  const double scale = safe_scale(std::max(
      {std::abs(a.x), std::abs(a.y), std::abs(b.x), std::abs(b.y), std::abs(c.x), std::abs(c.y)}));
  return {exact_area(scale, c, b), exact_area(scale, a, c), exact_area(scale, b, a)};
}

}  // namespace boxtree
