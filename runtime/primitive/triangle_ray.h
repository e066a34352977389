// SPDX-License-Identifier: MIT
// Watertight intersection of rays and triangles (Woop, Benthin, Wald, "Watertight Ray/Triangle
// Intersection", JCGT 2013), with exact signs.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "runtime/primitive/axis_lanes.h"
#include "runtime/primitive/triangle.h"

namespace boxtree {

/// A corner in the axes of the ray, which is the line x = y = 0. Depends on the corner and the ray
/// alone, so triangles that share the corner get the same numbers.
struct ShearedCorner {
  double x, y, z;
};

/// A ray prepared for tests against many triangles: the shear that maps the direction to an axis.
struct RayShear {
  RayShear() noexcept = default;  // unspecified
  /// Precondition: direction is finite and not zero.
  RayShear(const Eigen::Vector3d& ray_origin, const Eigen::Vector3d& direction) noexcept
      : origin(ray_origin) {
    set_axes(direction);
    // Finite even for a subnormal direction, so that a hit at the origin gets t = 0, not NaN.
    constexpr double kLargest = std::numeric_limits<double>::max();
    shear_z = std::clamp(1 / direction[axis_z], -kLargest, kLargest);
  }
  /// The same, where the reciprocals of the direction are known. Precondition: its largest
  /// component is in [1/2, 1).
  RayShear(const AxisLanes& ray_origin, const AxisLanes& direction,
           const AxisLanes& inverse) noexcept
      : origin(ray_origin.vector()) {
    set_axes(direction);
    shear_z = inverse[axis_z];
  }

  [[nodiscard]] ShearedCorner sheared(const Eigen::Vector3d& corner) const noexcept {
    const double z = corner[axis_z] - origin[axis_z];
    return {(corner[axis_x] - origin[axis_x]) - shear_x * z,
            (corner[axis_y] - origin[axis_y]) - shear_y * z, z};
  }

  Eigen::Vector3d origin;
  int axis_x, axis_y, axis_z;        // axis_z: largest component of the direction
  double shear_x, shear_y, shear_z;  // direction x/z, y/z, 1/z

 private:
  // Sets all but shear_z. No branch on which component is the largest: all are equally likely.
  template <class Vector>
  void set_axes(const Vector& direction) noexcept {
    const double x = std::abs(direction[0]), y = std::abs(direction[1]), z = std::abs(direction[2]);
    // By arithmetic, since compilers make branches of choices.
    const int y_larger = y > x;
    const int z_largest = (z > x) & (z > y);
    axis_z = y_larger + (2 - y_larger) * z_largest;
    static constexpr int kNext[] = {1, 2, 0, 1};
    axis_x = kNext[axis_z];
    axis_y = kNext[axis_z + 1];
    const double d = direction[axis_z];
    shear_x = direction[axis_x] / d;
    shear_y = direction[axis_y] / d;
  }
};

/// Parameter along the ray (in units of its direction) and barycentric weights of corners 1 and 2.
struct RayTriangleHit {
  double t;
  double u;
  double v;
};

/// Twice the signed areas that the ray spans with the edges opposite corners 0, 1 and 2.
struct RayEdges {
  double opposite0, opposite1, opposite2;

  [[nodiscard]] bool has_mixed_signs() const noexcept {
    return (opposite0 < 0 || opposite1 < 0 || opposite2 < 0) &&
           (opposite0 > 0 || opposite1 > 0 || opposite2 > 0);
  }
  [[nodiscard]] bool has_zero() const noexcept {
    return opposite0 == 0 || opposite1 == 0 || opposite2 == 0;
  }
};

/// The same areas, scaled by a common power of two, with exact signs and a relative error of an
/// ulp; zeros if the signs are mixed.
[[nodiscard]] RayEdges exact_ray_edges(const ShearedCorner& a, const ShearedCorner& b,
                                       const ShearedCorner& c) noexcept;

/// The part of the sum of its products from which on an area is that of doubles: its relative error
/// is then below 2^-43.
inline constexpr double kClearArea = 0x1p-8;

/// Where the line of the ray intersects the triangle, from either side, at any t (the caller bounds
/// it); nothing when it misses or the sheared triangle is edge-on. Two triangles that share an edge
/// or corner, bit for bit, leave no gap between them. t is finite or +-infinity, u and v are in [0,
/// 1].
///
/// A triangle without area is edge-on except for the rounding of the shear, so a ray that passes
/// through it to within that rounding may hit it. That is required: where such triangles close a
/// seam, between one long edge and the short ones beside it, they cover the gap that rounding
/// opens.
///
/// Weights are those of the sheared corners to within 2^-42, so the point that they give is as near
/// to the ray at t, however thin the triangle is seen. A triangle without area would otherwise be
/// hit at any of its points.
///
/// Why there is no gap. An area is fl(fl(x1 y2) - fl(x2 y1)). Rounding is monotone, so its sign is
/// exact or it is zero; zeros are computed again in exact arithmetic. So all signs are exact for
/// the sheared corners, which neighbours share: projected along the ray they are a mesh without
/// gaps, exactly. An edge of area zero belongs to both its triangles. Exact values are needed, not
/// just exact signs: a triangle with three false zeros would count as edge-on and leave a gap. A
/// triangle that truly is edge-on covers no area; its neighbours cover its line.
[[nodiscard]] inline std::optional<RayTriangleHit> intersect_ray_triangle(
    const RayShear& ray, const Triangle& triangle) noexcept {
  const ShearedCorner a = ray.sheared(triangle.corner[0]);
  const ShearedCorner b = ray.sheared(triangle.corner[1]);
  const ShearedCorner c = ray.sheared(triangle.corner[2]);
  const double cb = c.x * b.y, bc = c.y * b.x, ac = a.x * c.y, ca = a.y * c.x, ba = b.x * a.y,
               ab = b.y * a.x;
  RayEdges edges{cb - bc, ac - ca, ba - ab};
  if (edges.has_mixed_signs()) return std::nullopt;
  const double magnitude = ((std::abs(cb) + std::abs(bc)) + (std::abs(ac) + std::abs(ca))) +
                           (std::abs(ba) + std::abs(ab));
  double area = (edges.opposite0 + edges.opposite1) + edges.opposite2;
  if (edges.has_zero() || !(std::abs(area) >= kClearArea * magnitude)) [[unlikely]] {
    edges = exact_ray_edges(a, b, c);
    area = (edges.opposite0 + edges.opposite1) + edges.opposite2;
  }
  if (area == 0) return std::nullopt;
  // All signs agree, so each quotient is in [0, 1] and t a mean of the corners' own parameters.
  const double weight0 = edges.opposite0 / area;
  const double weight1 = edges.opposite1 / area;
  const double weight2 = edges.opposite2 / area;
  const double depth = (weight0 * a.z + weight1 * b.z) + weight2 * c.z;
  return RayTriangleHit{depth * ray.shear_z, weight1 + 0.0, weight2 + 0.0};  // not -0
}

/// Whether the ray meets the triangle, which it intersects, from the side from which the corners
/// are counterclockwise. Exact for the sheared corners.
[[nodiscard]] bool meets_front(const RayShear& ray, const Triangle& triangle) noexcept;

}  // namespace boxtree
