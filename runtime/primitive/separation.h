// SPDX-License-Identifier: MIT
// Lower bounds of distances that hold however their direction was found.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include <Eigen/Core>

#include "runtime/primitive/rounding.h"
#include "runtime/primitive/vector3.h"

namespace boxtree {

// Two convex sets are at least as far apart as their projections on any direction v, divided by
// |v|, whatever the error in v. Let u = 2^-53, |x|_1 the sum of magnitudes, R the largest
// coordinate. A computed projection v . x is off by at most 3 u |v|_1 R (1 + O(u)); the difference
// of two of them, rounded, by at most 8 u |v|_1 R (1 + O(u)) in all. The square root, the quotient
// and |v|^2 round by less than a factor 1 - 4 u together.
// Underflow: |v|_1 of at least 2^-400 keeps what products lose below 2^-600 of the quotient.
inline constexpr double kSeparationError = 10 * kRoundoffF64;
inline constexpr double kSeparationQuotient = 1 - 4 * kRoundoffF64;
inline constexpr double kSeparationUnderflow = 0x1p-600;
inline constexpr double kShortestDirection = 0x1p-400;

/// A lower bound of the distance between the convex hulls of two sets of points, by the gap between
/// them along `direction`, which points from the first to the second; 0 where that shows no gap.
/// `max_abs` is the largest absolute coordinate.
template <class First, class Second>
[[nodiscard]] double separation_along(const Eigen::Vector3d& direction, const First& first,
                                      const Second& second, double max_abs) noexcept {
  const auto project = [&direction](const Eigen::Vector3d& x) {
    return (direction[0] * x[0] + direction[1] * x[1]) + direction[2] * x[2];
  };
  double near = project(first[0]);
  for (std::size_t i = 1; i < first.size(); ++i) near = std::max(near, project(first[i]));
  double far = project(second[0]);
  for (std::size_t i = 1; i < second.size(); ++i) far = std::min(far, project(second[i]));
  const double size = (std::abs(direction[0]) + std::abs(direction[1])) + std::abs(direction[2]);
  if (!(size >= kShortestDirection)) return 0;
  const double gap = (far - near) - kSeparationError * size * max_abs;
  if (!(gap > 0)) return 0;
  const double length = std::sqrt(project(direction));
  return std::max(0.0, gap / length * kSeparationQuotient - kSeparationUnderflow);
}

/// A vector less its components along one or two others. Subtracted twice: the second time removes
/// what rounding leaves of them the first time.
[[nodiscard]] inline Eigen::Vector3d orthogonal_to(const Eigen::Vector3d& vector,
                                                   const Eigen::Vector3d& a,
                                                   const Eigen::Vector3d& b) noexcept {
  const auto without = [](const Eigen::Vector3d& v, const Eigen::Vector3d& along) {
    const double square = squared_length(along);
    return square > 0 ? Eigen::Vector3d(v - (dot(v, along) / square) * along) : v;
  };
  const Eigen::Vector3d height = without(without(b, a), a);
  Eigen::Vector3d left = vector;
  for (int time = 0; time < 2; ++time) left = without(without(left, a), height);
  return left;
}

/// The edges of a set of points: those of a triangle, or none.
[[nodiscard]] inline std::array<Eigen::Vector3d, 0> edges_of(
    std::span<const Eigen::Vector3d>) noexcept {
  return {};
}
template <std::size_t N>
[[nodiscard]] std::array<Eigen::Vector3d, N == 3 ? 3 : 0> edges_of(
    const std::array<Eigen::Vector3d, N>& points) noexcept {
  if constexpr (N == 3) {
    return {points[1] - points[0], points[2] - points[1], points[0] - points[2]};
  } else {
    return {};
  }
}

/// A lower bound of a distance, and the direction whose gap it is, of any length.
struct Separation {
  // Not inlined: up to twenty are tried where rounding hides the gap, and few elsewhere.
  template <class First, class Second>
  [[gnu::noinline]] void consider(const Eigen::Vector3d& other, const First& first,
                                  const Second& second, double max_abs) noexcept {
    const double gap = separation_along(other, first, second, max_abs);
    if (!(gap > lower)) return;
    lower = gap;
    direction = other;
  }

  double lower = 0;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
};

/// Makes the best of directions near `direction` that are orthogonal to a face, to an edge, or to
/// an edge of each set (see edges_of). They are computed from the edges, which are more accurate
/// than vectors from an inner point to a corner; needles need this.
template <class FirstEdges, class SecondEdges, class First, class Second>
void separate_on_features(const Eigen::Vector3d& direction, const FirstEdges& first_edges,
                          const SecondEdges& second_edges, const First& first, const Second& second,
                          double max_abs, Separation& best) noexcept {
  const auto consider = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    best.consider(orthogonal_to(direction, a, b), first, second, max_abs);
  };
  const auto consider_one = [&](const auto& edges) {
    for (std::size_t i = 0; i < edges.size(); ++i) {
      consider(edges[i], Eigen::Vector3d::Zero());
      consider(edges[i], edges[(i + 1) % 3]);
    }
  };
  consider_one(first_edges);
  consider_one(second_edges);
  for (const Eigen::Vector3d& a : first_edges) {
    for (const Eigen::Vector3d& b : second_edges) consider(a, b);
  }
}

/// A lower bound of the distance between the hulls of two sets of points, given a nearly closest
/// point of each. The direction is the line between these points. If they are close to each other,
/// rounding tilts that line, and the projection of a distant corner crosses the gap. The direction
/// is then made orthogonal to the vector to that corner, and if need be to a second one, and at
/// last to each edge and face of sets that are triangles. A bound of `enough` is not improved.
template <class First, class Second>
[[nodiscard]] Separation separation_near(const Eigen::Vector3d& on_first,
                                         const Eigen::Vector3d& on_second, const First& first,
                                         const Second& second, double max_abs,
                                         double enough) noexcept {
  const Eigen::Vector3d between = on_second - on_first;
  Eigen::Vector3d direction = between;
  Separation best;
  best.consider(direction, first, second, max_abs);
  std::array<Eigen::Vector3d, 2> arms;
  for (std::size_t n = 0; n < arms.size() && best.lower < enough; ++n) {
    arms[n].setZero();
    double least = 0;
    const auto consider = [&](const Eigen::Vector3d& arm) {
      const double reached = dot(direction, arm);
      if (!(reached < least)) return;
      least = reached;
      arms[n] = arm;
    };
    for (const Eigen::Vector3d& corner : first) consider(on_first - corner);
    for (const Eigen::Vector3d& corner : second) consider(corner - on_second);
    if (n == 1) arms[1] -= (dot(arms[1], arms[0]) / dot(arms[0], arms[0])) * arms[0];
    if (!(dot(arms[n], arms[n]) > 0)) break;
    for (std::size_t i = 0; i <= n; ++i) {
      direction -= (dot(direction, arms[i]) / dot(arms[i], arms[i])) * arms[i];
    }
    best.consider(direction, first, second, max_abs);
  }
  if (best.lower < enough) {
    separate_on_features(between, edges_of(first), edges_of(second), first, second, max_abs, best);
  }
  return best;
}

/// The largest magnitude of any coordinate of these points.
template <std::size_t N>
[[nodiscard]] double max_abs_of(const std::array<Eigen::Vector3d, N>& points) noexcept {
  double max_abs = 0;
  for (const Eigen::Vector3d& p : points) {
    for (Eigen::Index k = 0; k < 3; ++k) max_abs = std::max(max_abs, std::abs(p[k]));
  }
  return max_abs;
}

}  // namespace boxtree
