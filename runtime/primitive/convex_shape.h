// SPDX-License-Identifier: MIT
// The convex shapes that queries take, and what one needs to know of one and a triangle: distance,
// where they touch, on what part of the triangle. Triangles are relative to the shape's center, so
// that what is far from the origin is computed with the digits of its own size.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include <boxtree/shape.h>

#include "runtime/primitive/rounding.h"
#include "runtime/primitive/triangle.h"
#include "runtime/primitive/vector3.h"

namespace boxtree {

using Corners = std::array<Eigen::Vector3d, 3>;

struct CoreDistance;
struct Penetration;

/// A hull: its points relative to its center, and what is known of them and a triangle. By
/// pointers, so that a program without hulls links none of it.
struct ConvexPoints {
  std::span<const Eigen::Vector3d> point;
  /// As core_distance(); 0 where the triangle is inside.
  CoreDistance (*distance)(std::span<const Eigen::Vector3d> points, const Corners& corner) noexcept;
  /// As penetration(); `against`: null, or of the normals only those against this direction.
  Penetration (*penetration)(std::span<const Eigen::Vector3d> points, const Corners& corner,
                             double doubt, const Eigen::Vector3d* against) noexcept;
};

/// All points within `radius` of center + [-1, 1] half[0] axis[0] + ... over `axes` axes: a sphere
/// (no axis), a capsule (one) or a box (three, then without a radius). What bounds the image of one
/// in another space may have both, and axes that are not orthogonal. Or a hull: then
/// the box holds it.
struct ConvexShape {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  // Of length 1 but for rounding; of a capsule, any.
  std::array<Eigen::Vector3d, 3> axis = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                                         Eigen::Vector3d::Zero()};
  std::array<double, 3> half{};
  std::uint32_t axes = 0;
  double radius = 0;
  const ConvexPoints* hull = nullptr;
  double error = 0;  // by which a center may be off before it is rounded; bounds hold it

  /// Half the extent of its bounds, on every axis, not rounded down.
  [[nodiscard]] Eigen::Vector3d half_extents() const noexcept;
};

/// Relative to a point.
[[nodiscard]] inline Corners relative_to(const Eigen::Vector3d& point,
                                         const Triangle& triangle) noexcept {
  return {triangle.corner[0] - point, triangle.corner[1] - point, triangle.corner[2] - point};
}

/// A triangle and the core of a shape, whose center is the origin, along a vector of any length.
struct Projection {
  double low, high;  // of the triangle
  double half;       // of the core, to either side of 0
};
[[nodiscard]] inline Projection project(const Eigen::Vector3d& vector, const ConvexShape& shape,
                                        const Corners& corner) noexcept {
  Projection found{dot(vector, corner[0]), 0, 0};
  found.high = found.low;
  for (std::size_t c = 1; c < corner.size(); ++c) {
    const double at = dot(vector, corner[c]);
    found.low = std::min(found.low, at);
    found.high = std::max(found.high, at);
  }
  for (std::uint32_t k = 0; k < shape.axes; ++k) {
    found.half += std::abs(dot(vector, shape.axis[k])) * shape.half[k];
  }
  return found;
}

/// What is known of the distance of a core (a point or a segment) from a triangle.
struct CoreDistance {
  double lower;             // of the distance
  double upper;             // likewise
  double length;            // of `between`
  Eigen::Vector3d core;     // its closest point
  Eigen::Vector3d between;  // from there to the closest point of the triangle
  double along;             // of the gap along `apart`, or 0
  Eigen::Vector3d apart;    // the best direction to see them apart, of any length
};

/// Points of the core of a sphere or capsule and of a triangle that are closest to each other, to
/// within rounding; of a core that pierces the triangle they need not be. A fraction of what
/// core_distance() costs.
struct ClosestPoints {
  double upper;  // of the distance of core and triangle
  Eigen::Vector3d core;
  Eigen::Vector3d between;  // from there to that of the triangle
};
[[nodiscard]] ClosestPoints closest_points(const ConvexShape& shape,
                                           const Corners& corner) noexcept;
/// The same of a core that may pierce the triangle; at the cost of core_distance() if it seems to.
[[nodiscard]] ClosestPoints contact_points(const ConvexShape& shape,
                                           const Corners& corner) noexcept;

/// What of a capsule's core may be closest to a triangle: an end, or what lies between them, to
/// one of the edges. A guess that says where to look first; in the order of
/// closest_points_of_part().
enum class CoreGuess : std::uint8_t { kNone, kFirstEnd, kLastEnd, kEdge0, kEdge1, kEdge2 };

/// Points of core and triangle that are closest to each other if the guess is right; those of
/// closest_points() without one.
[[nodiscard]] ClosestPoints guessed_points(const ConvexShape& shape, const Corners& corner,
                                           CoreGuess guess) noexcept;
/// contact_points(), at less cost where the guess is right.
[[nodiscard]] ClosestPoints contact_points(const ConvexShape& shape, const Corners& corner,
                                           CoreGuess guess) noexcept;
/// From those that closest_points() has found.
[[nodiscard]] ClosestPoints contact_points(const ConvexShape& shape, const Corners& corner,
                                           const ClosestPoints& points) noexcept;

/// How far the distance of a point from a triangle is off, in units of the largest coordinate:
/// closest_point.cpp has seen 8 u.
inline constexpr double kPointDistanceError = 16 * kRoundoffF64;

/// Of a sphere, capsule or hull. Its center is the origin.
[[nodiscard]] CoreDistance core_distance(const ConvexShape& shape, const Corners& corner) noexcept;

/// A part of a triangle.
struct TrianglePart {
  Feature feature = Feature::kFace;
  std::uint8_t index = 0;  // of a vertex, or of an edge, from this corner to the next

  /// What has these corners, bit i: corner i.
  [[nodiscard]] static TrianglePart with_corners(std::uint32_t corners) noexcept;
};

/// What of the triangle closest_point_on_triangle() has found for `point`.
[[nodiscard]] TrianglePart feature_of(const Eigen::Vector3d& point, const Corners& corner,
                                      const Eigen::Vector3d& closest) noexcept;

/// The part of the triangle that is farthest along a direction, to within `error`.
[[nodiscard]] TrianglePart farthest_feature(const Eigen::Vector3d& direction, const Corners& corner,
                                            double error) noexcept;

/// A point of the triangle inside a box that is widened by `widened`: the middle of what the box
/// holds of it. The point closest to the center if it holds nothing.
[[nodiscard]] Eigen::Vector3d point_inside_box(const ConvexShape& box, double widened,
                                               const Corners& corner) noexcept;

}  // namespace boxtree
