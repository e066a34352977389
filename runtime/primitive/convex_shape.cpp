// SPDX-License-Identifier: MIT
// Distances of cores and points of contact.
#include "runtime/primitive/convex_shape.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "runtime/primitive/box_axes.h"
#include "runtime/primitive/closest_point.h"
#include "runtime/primitive/rounding.h"
#include "runtime/primitive/separation.h"
#include "runtime/primitive/triangle_distance.h"
#include "runtime/primitive/vector3.h"

namespace boxtree {

Eigen::Vector3d ConvexShape::half_extents() const noexcept {
  Eigen::Vector3d extent = Eigen::Vector3d::Constant(radius + error);
  for (std::uint32_t i = 0; i < axes; ++i) extent += half[i] * axis[i].cwiseAbs();
  return extent * (1 + 8 * kRoundoffF64);
}

namespace {

double point_distance_error(double max_abs) noexcept {
  return kPointDistanceError * max_abs + kSeparationUnderflow;
}

}  // namespace

ClosestPoints closest_points(const ConvexShape& shape, const Corners& corner) noexcept {
  if (shape.axes == 0) {
    const Eigen::Vector3d point = Eigen::Vector3d::Zero();
    const Eigen::Vector3d between = closest_point_on_triangle(point, {corner});
    return {std::sqrt(squared_length(between)) + point_distance_error(max_abs_of(corner)), point,
            between};
  }
  const Eigen::Vector3d arm = shape.half[0] * shape.axis[0];
  const TriangleDistance found = segment_closest_points(-arm, arm, {corner});
  return {found.upper, found.first, found.second - found.first};
}

ClosestPoints contact_points(const ConvexShape& shape, const Corners& corner) noexcept {
  return contact_points(shape, corner, closest_points(shape, corner));
}

ClosestPoints guessed_points(const ConvexShape& shape, const Corners& corner,
                             CoreGuess guess) noexcept {
  if (guess == CoreGuess::kNone || shape.axes == 0) return closest_points(shape, corner);
  const Eigen::Vector3d arm = shape.half[0] * shape.axis[0];
  const TriangleDistance found = closest_points_of_part(
      -arm, arm, {corner},
      static_cast<std::size_t>(guess) - static_cast<std::size_t>(CoreGuess::kFirstEnd));
  return {found.upper, found.first, found.second - found.first};
}

namespace {

// Whether nothing is closer: what the line between the points separates by their distance, but for
// rounding, has no closer points.
bool are_closest(const ConvexShape& shape, const Corners& corner,
                 const ClosestPoints& points) noexcept {
  const auto [low, high, half] = project(points.between, shape, corner);
  const double square = squared_length(points.between);
  const double error =
      points.upper - std::sqrt(square) + kSeparationError * (max_abs_of(corner) + half);
  return square > 0 && low - half >= square - 2 * error * std::sqrt(square);
}

}  // namespace

ClosestPoints contact_points(const ConvexShape& shape, const Corners& corner,
                             CoreGuess guess) noexcept {
  if (guess != CoreGuess::kNone && shape.axes != 0) {
    const ClosestPoints points = guessed_points(shape, corner, guess);
    if (are_closest(shape, corner, points)) return points;
  }
  return contact_points(shape, corner);
}

ClosestPoints contact_points(const ConvexShape& shape, const Corners& corner,
                             const ClosestPoints& points) noexcept {
  if (shape.axes == 0 || are_closest(shape, corner, points)) return points;
  const CoreDistance certain = core_distance(shape, corner);
  return {certain.upper, certain.core, certain.between};
}

CoreDistance core_distance(const ConvexShape& shape, const Corners& corner) noexcept {
  if (shape.hull != nullptr) return shape.hull->distance(shape.hull->point, corner);
  CoreDistance found;
  double max_abs = max_abs_of(corner);
  if (shape.axes == 0) {
    const std::array<Eigen::Vector3d, 1> core{Eigen::Vector3d::Zero()};
    found.core = core[0];
    found.between = closest_point_on_triangle(core[0], {corner});
    found.length = std::sqrt(squared_length(found.between));
    const double error = point_distance_error(max_abs);
    found.lower = std::max(0.0, found.length - error);
    found.upper = found.length + error;
    found.along = separation_along(found.between, core, corner, max_abs);
    found.apart = found.between;
    return found;
  }
  const Eigen::Vector3d arm = shape.half[0] * shape.axis[0];
  max_abs = std::max(max_abs, largest_magnitude(arm));
  const TriangleDistance distance = segment_distance(-arm, arm, {corner});
  found.lower = distance.lower;
  found.upper = distance.upper;
  found.core = distance.first;
  found.between = distance.second - distance.first;
  found.length = std::sqrt(squared_length(found.between));
  found.along = distance.lower;
  found.apart = distance.apart;
  return found;
}

TrianglePart TrianglePart::with_corners(std::uint32_t corners) noexcept {
  constexpr std::array<TrianglePart, 8> kParts = {{{Feature::kFace, 0},
                                                   {Feature::kVertex, 0},
                                                   {Feature::kVertex, 1},
                                                   {Feature::kEdge, 0},
                                                   {Feature::kVertex, 2},
                                                   {Feature::kEdge, 2},
                                                   {Feature::kEdge, 1},
                                                   {Feature::kFace, 0}}};
  return kParts[corners];
}

TrianglePart feature_of(const Eigen::Vector3d& point, const Corners& corner,
                        const Eigen::Vector3d& closest) noexcept {
  return TrianglePart::with_corners(closest_corners(point, {corner}, closest));
}

TrianglePart farthest_feature(const Eigen::Vector3d& direction, const Corners& corner,
                              double error) noexcept {
  const double farthest =
      std::max({dot(direction, corner[0]), dot(direction, corner[1]), dot(direction, corner[2])});
  std::uint32_t corners = 0;
  for (std::uint32_t i = 0; i < corner.size(); ++i) {
    if (dot(direction, corner[i]) >= farthest - error) corners |= 1u << i;
  }
  return TrianglePart::with_corners(corners);
}

// The mean of the corners of what the box cuts out (Sutherland and Hodgman, "Reentrant Polygon
// Clipping", 1974), in the frame of its axes.
Eigen::Vector3d point_inside_box(const ConvexShape& box, double widened,
                                 const Corners& corner) noexcept {
  constexpr std::size_t kMost = 9;  // each of six planes adds one at most
  using Polygon = std::array<Eigen::Vector3d, kMost + 1>;
  std::array<Polygon, 2> polygons;
  Polygon* polygon = &polygons[0];
  Polygon* kept = &polygons[1];
  for (std::size_t i = 0; i < corner.size(); ++i) (*polygon)[i] = in_frame_of(box, corner[i]);
  std::size_t count = 3;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    for (const double side : {-1.0, 1.0}) {
      const auto depth = [&](const Eigen::Vector3d& p) {
        return box.half[k] + widened - side * p[axis];
      };
      bool is_inside = true;
      for (std::size_t i = 0; i < count; ++i) is_inside &= depth((*polygon)[i]) >= 0;
      if (is_inside) continue;
      std::size_t left = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const Eigen::Vector3d& a = (*polygon)[i];
        const Eigen::Vector3d& b = (*polygon)[i + 1 == count ? 0 : i + 1];
        const double of_a = depth(a), of_b = depth(b);
        if (of_a >= 0 && left < kMost) (*kept)[left++] = a;
        if ((of_a >= 0) != (of_b >= 0) && left < kMost) {
          (*kept)[left++] = a + (of_a / (of_a - of_b)) * (b - a);
        }
      }
      std::swap(polygon, kept);
      count = left;
    }
  }
  if (count == 0) return closest_point_on_triangle(Eigen::Vector3d::Zero(), {corner});
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < count; ++i) sum += (*polygon)[i];
  return from_frame_of(box, sum / static_cast<double>(count));
}

}  // namespace boxtree
