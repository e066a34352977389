// SPDX-License-Identifier: MIT
// Closest point of a triangle: the foot of the perpendicular where it lies inside, otherwise the
// best of the edges.
//
// The foot is found by orthogonalisation, not from areas: it is a + s e + t f with e = b - a and f
// = (c - a) - k e orthogonal to e. Let u = 2^-53, G and F the lengths of c - a and f, W the
// distance from a to the point, h the point's height over the plane. Along e the foot is off by a
// few units u (W + G). Across e it is off because the direction of f is, by a few u G / F: by a few
// u (G + h G / F), but never by more than F, as t is in [0, 1]. A move m inside the plane adds at
// most m^2 / (2 h) <= m F / (2 h) to the distance, or m itself: a few u G either way, however thin
// the triangle is. For the same reason a foot within such a move of an edge may count as on either
// side of it, as all edges are then tried. So the distance is within a few units in the last place
// of the coordinates for every shape, needles and collinear corners included; the largest error
// seen against exact arithmetic is 8 u.
#include "runtime/primitive/closest_point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "runtime/primitive/vector3.h"

namespace boxtree {
namespace {

double largest(const Eigen::Vector3d& v) {
  return std::max(std::max(std::abs(v[0]), std::abs(v[1])), std::abs(v[2]));
}

// A point of a segment. An end is returned as it is, not as a rounded combination.
Eigen::Vector3d on_segment(const Eigen::Vector3d& from, const Eigen::Vector3d& edge,
                           const Eigen::Vector3d& to, double fraction) {
  if (!(fraction > 0)) return from;  // also for NaN: the ends coincide
  return fraction >= 1 ? to : from + fraction * edge;
}

Eigen::Vector3d closest_on_segment(const Eigen::Vector3d& point, const Eigen::Vector3d& from,
                                   const Eigen::Vector3d& to) {
  const Eigen::Vector3d edge = to - from;
  return on_segment(from, edge, to, dot(point - from, edge) / squared_length(edge));
}

// The closest of the points tried so far.
struct Nearest {
  void consider(const Eigen::Vector3d& candidate) noexcept {
    const double candidate_distance = squared_length(query - candidate);
    if (candidate_distance >= distance) return;
    best = candidate;
    distance = candidate_distance;
  }

  const Eigen::Vector3d& query;
  Eigen::Vector3d best;
  double distance = std::numeric_limits<double>::infinity();
};

// Precondition: the square of b - a is not below kShortestSquare, or `has_foot` is false.
Eigen::Vector3d closest_point(const Eigen::Vector3d& point, const Eigen::Vector3d& a,
                              const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                              bool has_foot) noexcept {
  const Eigen::Vector3d base = b - a;
  const Eigen::Vector3d side = c - a;
  const Eigen::Vector3d away = point - a;
  const double base_square = squared_length(base);
  const double side_along = dot(side, base) / base_square;
  const double away_along = dot(away, base) / base_square;
  const Eigen::Vector3d height = side - side_along * base;
  const double height_square = squared_length(height);
  const double weight_c = dot(away - away_along * base, height) / height_square;
  const double weight_b = away_along - weight_c * side_along;
  // False for NaN, as for collinear corners.
  if (has_foot && weight_b >= 0 && weight_c >= 0 && weight_b + weight_c <= 1) {
    return a + (weight_b * base + weight_c * side);
  }

  // If the foot is certainly outside some edge, the closest point lies on an edge that has the foot
  // outside. Edges that certainly have it inside are skipped.
  const double weight_a = (1 - weight_b) - weight_c;
  const double side_square = squared_length(side);
  // No branch per condition: they are hard to predict.
  bool outside = has_foot;
  outside &= std::min(weight_a, std::min(weight_b, weight_c)) < -kWeightError;
  outside &= std::min(height_square, base_square) > kThin * std::max(side_square, base_square);
  outside &= squared_length(away) < kFar * base_square;
  Nearest nearest{point, a};
  if (!outside || weight_c <= kWeightError) {
    nearest.consider(on_segment(a, base, b, away_along));
  }
  if (!outside || weight_b <= kWeightError) {
    nearest.consider(on_segment(a, side, c, dot(away, side) / side_square));
  }
  if (!outside || weight_a <= kWeightError) nearest.consider(closest_on_segment(point, b, c));
  return nearest.best;
}

// For a triangle with a very short edge: computes in units of its size or of the point's distance,
// whichever is larger. If the edge is short in these units, too, the triangle is a segment to
// within rounding.
Eigen::Vector3d closest_point_by_size(const Eigen::Vector3d& point,
                                      const std::array<Eigen::Vector3d, 3>& corner) noexcept {
  const Eigen::Vector3d& a = corner[0];
  const Eigen::Vector3d base = corner[1] - a, side = corner[2] - a, away = point - a;
  const double size = std::max({largest(base), largest(side), largest(away)});
  if (size == 0) return a;
  constexpr int kMostExponent = 1000;  // 2^1000 is finite, and 2^74 times the least number
  const int exponent = std::min(-std::ilogb(size), kMostExponent);
  const double scale = std::ldexp(1.0, exponent);
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  const bool has_foot = squared_length(scale * base) >= kShortestSquare;
  const Eigen::Vector3d found =
      closest_point(scale * away, zero, scale * base, scale * side, has_foot);
  return a + found * std::ldexp(1.0, -exponent);
}

}  // namespace

Eigen::Vector3d closest_point_on_triangle(const Eigen::Vector3d& point,
                                          const Triangle& triangle) noexcept {
  const auto& [a, b, c] = triangle.corner;
  if (squared_length(b - a) < kShortestSquare) [[unlikely]] {
    return closest_point_by_size(point, triangle.corner);
  }
  return closest_point(point, a, b, c, true);
}

// The closest point of an edge is computed alike here and there, to the last bit, but for triangles
// that are computed by size: those with two corners in one point, up to rounding.
std::uint32_t closest_corners(const Eigen::Vector3d& point, const Triangle& triangle,
                              const Eigen::Vector3d& closest) noexcept {
  const auto& [a, b, c] = triangle.corner;
  if (closest == a) return 1;
  if (closest == b) return 2;
  if (closest == c) return 4;
  if (closest == closest_on_segment(point, a, b)) return 3;
  if (closest == closest_on_segment(point, a, c)) return 5;
  if (closest == closest_on_segment(point, b, c)) return 6;
  return squared_length(b - a) < kShortestSquare ? 5 : 7;
}

}  // namespace boxtree
