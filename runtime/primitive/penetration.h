// SPDX-License-Identifier: MIT
// How a convex shape that touches a triangle leaves it soonest.
#pragma once

#include <optional>

#include "runtime/primitive/convex_shape.h"

namespace boxtree {

struct Penetration {
  Eigen::Vector3d point;   // on the triangle, relative to the shape's center
  Eigen::Vector3d normal;  // from the triangle to the shape
  double depth;            // along it
  TrianglePart feature;
};

/// How far the depth along a direction is off, in units of the largest coordinate, besides what
/// `doubt` below makes of it.
inline constexpr double kDepthError = 32 * kRoundoffF64;

/// Precondition: they touch. `corner`: relative to the shape's center; `doubt`: how far these may
/// be off. Of a hull the depth is least to within 2^-46 of the largest coordinate.
[[nodiscard]] Penetration penetration(const ConvexShape& shape, const Corners& corner,
                                      double doubt) noexcept;

/// Of a box, or nothing where some axis shows that they do not touch, by more than rounding.
[[nodiscard]] std::optional<Penetration> box_penetration(const ConvexShape& box,
                                                         const Triangle& triangle,
                                                         const Corners& corner,
                                                         double doubt) noexcept;

/// Of a sphere or capsule; `closest`: as contact_points() found them.
[[nodiscard]] Penetration penetration_of_core(const ConvexShape& shape, const Corners& corner,
                                              double doubt, const ClosestPoints& closest) noexcept;

}  // namespace boxtree
