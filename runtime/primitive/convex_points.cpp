// SPDX-License-Identifier: MIT
// The distance of a hull from a triangle is that of the origin from their Minkowski difference: the
// differences of their points. It is approached by triangles of three of these (Gilbert, Johnson,
// Keerthi, "A Fast Procedure for Computing the Distance Between Complex Objects in Three-
// Dimensional Space", 1988). Near a touch what is left is the distance of two triangles, which is
// computed from their own edges. No bound relies on any of this: the lower one is what a direction
// separates.
#include "runtime/primitive/convex_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "runtime/primitive/closest_point.h"
#include "runtime/primitive/rounding.h"
#include "runtime/primitive/separation.h"
#include "runtime/primitive/triangle_distance.h"
#include "runtime/primitive/vector3.h"

namespace boxtree {
namespace {

// The distance falls with each step, so that no triangle comes twice; after so many it is as good
// as the bounds that are computed in any case say.
constexpr int kMostDirections = 64;

using Differences = std::array<DifferencePoint, 3>;

std::uint32_t farthest_point(std::span<const Eigen::Vector3d> point,
                             const Eigen::Vector3d& direction) noexcept {
  std::uint32_t best = 0;
  double most = dot(direction, point[0]);
  for (std::uint32_t i = 1; i < point.size(); ++i) {
    const double along = dot(direction, point[i]);
    if (!(along > most)) continue;
    most = along;
    best = i;
  }
  return best;
}

struct SupportSearch {
  SupportSearch(std::span<const Eigen::Vector3d> points, const Corners& of_triangle) noexcept
      : point(points), corner(of_triangle), largest(max_abs_of(of_triangle)) {
    for (const Eigen::Vector3d& p : point) largest = std::max(largest, largest_magnitude(p));
  }

  [[nodiscard]] DifferencePoint least(const Eigen::Vector3d& direction) const noexcept {
    return least_difference(point, corner, direction);
  }

  [[nodiscard]] double separation(const Eigen::Vector3d& direction) const noexcept {
    return separation_along(direction, point, corner, largest);
  }

  [[nodiscard]] Corners points_of(const Differences& d) const noexcept {
    return {point[d[0].point], point[d[1].point], point[d[2].point]};
  }

  std::span<const Eigen::Vector3d> point;
  const Corners& corner;
  double largest;  // coordinate
};

// Of the origin.
Eigen::Vector3d closest(const Differences& d) noexcept {
  return closest_point_on_triangle(Eigen::Vector3d::Zero(), {{d[0].at, d[1].at, d[2].at}});
}

// Six times the volume between the origin and three points.
double volume(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
              const Eigen::Vector3d& c) noexcept {
  return dot(a, cross(b, c));
}

// The weights of a tetrahedron's corners whose mean the origin is, if it is inside by more than
// `error`, a volume; the last one is that of `apex`.
bool holds_origin(const Differences& d, const DifferencePoint& apex, double error,
                  std::array<double, 4>& weight) noexcept {
  weight = {volume(d[1].at, d[2].at, apex.at), -volume(d[0].at, d[2].at, apex.at),
            volume(d[0].at, d[1].at, apex.at), -volume(d[0].at, d[1].at, d[2].at)};
  const double sum = (weight[0] + weight[1]) + (weight[2] + weight[3]);
  for (double& w : weight) {
    if (!((sum < 0 ? -w : w) > error)) return false;
    w /= sum;
  }
  return true;
}

CoreDistance touching_at(const Eigen::Vector3d& point) noexcept {
  return {0, 0, 0, point, Eigen::Vector3d::Zero(), 0, Eigen::Vector3d::Zero()};
}

// By a triangle of the hull's points that is about as close as any: exchanges its points for others
// as long as that brings it nearer.
CoreDistance distance_of_triangle(const SupportSearch& search, Corners hull) noexcept {
  const Corners& corner = search.corner;
  TriangleDistance found = triangle_distance({hull}, {corner});
  const double error = 64 * kRoundoffF64 * search.largest;
  Separation apart;
  for (int step = 0; step < kMostDirections; ++step) {
    const Eigen::Vector3d between = found.second - found.first;
    apart = separation_near(found.first, found.second, search.point, corner, search.largest,
                            found.upper - error);
    if (apart.lower >= found.upper - error) break;
    TriangleDistance best = found;
    Corners best_hull = hull;
    const auto exchange_for = [&](const Eigen::Vector3d& other) {
      for (std::size_t i = 0; i < 3; ++i) {
        Corners exchanged = hull;
        exchanged[i] = other;
        const TriangleDistance nearer = triangle_distance({exchanged}, {corner});
        if (!(nearer.upper < best.upper)) continue;
        best = nearer;
        best_hull = exchanged;
      }
    };
    exchange_for(search.point[farthest_point(search.point, between)]);
    if (!(best.upper < found.upper)) {
      separate_on_features(between, edges_of(hull), edges_of(corner), search.point, corner,
                           search.largest, apart);
      if (apart.lower >= found.upper - error) break;
      // Rounding tilts a short line: the farthest point along it may be another.
      for (const Eigen::Vector3d& other : search.point) exchange_for(other);
      if (!(best.upper < found.upper)) break;
    }
    found = best;
    hull = best_hull;
  }
  CoreDistance out;
  out.between = found.second - found.first;
  out.core = found.first;
  out.lower = out.along = apart.lower;
  out.upper = found.upper;
  out.length = std::sqrt(squared_length(out.between));
  out.apart = apart.direction;
  return out;
}

}  // namespace

DifferencePoint least_difference(std::span<const Eigen::Vector3d> points, const Corners& corner,
                                 const Eigen::Vector3d& direction) noexcept {
  std::uint32_t low = 0;
  for (std::uint32_t i = 1; i < 3; ++i) {
    if (dot(direction, corner[i]) < dot(direction, corner[low])) low = i;
  }
  const std::uint32_t high = farthest_point(points, direction);
  return {corner[low] - points[high], low, high};
}

Eigen::Vector3d weights_in(const Corners& triangle, const Eigen::Vector3d& point) noexcept {
  const Eigen::Vector3d at = closest_point_on_triangle(point, {triangle});
  // By areas, as seen along the axis along which they are largest.
  const Eigen::Vector3d n = cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
  Eigen::Index axis = 0;
  static_cast<void>(n.cwiseAbs().maxCoeff(&axis));
  Eigen::Vector3d weight;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d a = triangle[(i + 1) % 3] - at, b = triangle[(i + 2) % 3] - at;
    const double area = cross(a, b)[axis];
    weight[static_cast<Eigen::Index>(i)] = std::max(0.0, n[axis] < 0 ? -area : area);
  }
  const double sum = (weight[0] + weight[1]) + weight[2];
  const auto miss = [&](const Eigen::Vector3d& w) {
    return squared_length((w[0] * triangle[0] + w[1] * triangle[1]) + w[2] * triangle[2] - at);
  };
  Eigen::Vector3d best = sum > 0 ? Eigen::Vector3d(weight / sum) : Eigen::Vector3d::UnitX();
  double least = miss(best);
  // Of a triangle with hardly any area, as where corners are one, the point is on an edge.
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const Eigen::Vector3d edge = triangle[j] - triangle[i];
    const double square = squared_length(edge);
    if (!(square > 0)) continue;
    const double along = std::clamp(dot(at - triangle[i], edge) / square, 0.0, 1.0);
    Eigen::Vector3d on_edge = Eigen::Vector3d::Zero();
    on_edge[static_cast<Eigen::Index>(i)] = 1 - along;
    on_edge[static_cast<Eigen::Index>(j)] = along;
    const double missed = miss(on_edge);
    if (!(missed < least)) continue;
    least = missed;
    best = on_edge;
  }
  return best;
}

CoreDistance hull_distance(std::span<const Eigen::Vector3d> points,
                           const Corners& corner) noexcept {
  const SupportSearch search(points, corner);
  const double size = search.largest;
  // Closer than that the line between two points is not trusted.
  constexpr double kNear = 0x1p-20;
  // What differences and their products are off by, as a share of their size.
  constexpr double kShare = 64 * kRoundoffF64;
  const double volume_error = kShare * (size * size * size);
  Eigen::Vector3d way = (corner[0] + corner[1]) + corner[2];
  if (way.isZero(0)) way = Eigen::Vector3d::UnitX();
  const DifferencePoint first = search.least(way);
  Differences difference{first, first, first};
  way = first.at;
  double squared = squared_length(way);
  for (int step = 0; step < kMostDirections && squared > kShare * kShare * size * size; ++step) {
    const DifferencePoint next = search.least(way);
    if (!(dot(way, next.at) < squared * (1 - 16 * kRoundoffF64))) break;
    std::array<double, 4> weight;
    if (holds_origin(difference, next, volume_error, weight)) {
      Eigen::Vector3d inside = weight[3] * corner[next.corner];
      for (std::size_t i = 0; i < 3; ++i) inside += weight[i] * corner[difference[i].corner];
      return touching_at(inside);
    }
    Differences best = difference;
    double least = squared;
    for (std::size_t i = 0; i < 3; ++i) {
      Differences exchanged = difference;
      exchanged[i] = next;
      const Eigen::Vector3d nearer = closest(exchanged);
      const double length = squared_length(nearer);
      if (!(length < least)) continue;
      least = length;
      best = exchanged;
      way = nearer;
    }
    if (!(least < squared)) break;
    squared = least;
    difference = best;
  }
  if (squared > kNear * kNear * size * size) {
    const double length = std::sqrt(squared);
    const double along = search.separation(way);
    if (along >= length / 2) {
      const Eigen::Vector3d weight = weights_in(
          {difference[0].at, difference[1].at, difference[2].at}, Eigen::Vector3d::Zero());
      Eigen::Vector3d core = Eigen::Vector3d::Zero();
      for (std::size_t i = 0; i < 3; ++i) {
        core += weight[static_cast<Eigen::Index>(i)] * points[difference[i].point];
      }
      // closest_point.cpp: off by a few u of the largest coordinate.
      return {along, length + 32 * kRoundoffF64 * size, length, core, way, along, way};
    }
  }
  return distance_of_triangle(search, search.points_of(difference));
}

}  // namespace boxtree
