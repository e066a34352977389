// SPDX-License-Identifier: MIT
// Seeded pairs of triangles with integer coordinates, in the families that break overlap tests.
// Integers of any size that a double holds: exact oracles can then use integer arithmetic.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <ostream>
#include <random>
#include <utility>

#include "runtime/primitive/triangle.h"

namespace boxtree::test {

enum class Family {
  kRandom,
  kGrid,
  kNearCoplanar,
  kCoplanar,
  kEdgeTouching,
  kVertexTouching,
  kSliver,
  kDegenerate,
};

inline constexpr std::array kFamilies = {
    Family::kRandom,       Family::kGrid,           Family::kNearCoplanar, Family::kCoplanar,
    Family::kEdgeTouching, Family::kVertexTouching, Family::kSliver,       Family::kDegenerate};

inline const char* name_of(Family family) {
  constexpr std::array kNames = {"random",   "grid",          "near-coplanar",
                                 "coplanar", "edge-touching", "vertex-touching",
                                 "sliver",   "degenerate"};
  return kNames[static_cast<std::size_t>(family)];
}

// How GoogleTest, and from there ctest, names a case.
inline void PrintTo(Family family, std::ostream* out) {
  *out << name_of(family);
}

using TrianglePair = std::pair<Triangle, Triangle>;

/// Coordinates have magnitudes up to 32 `range`; range must be a power of two of at least 64.
class TriangleCases {
 public:
  TriangleCases(std::uint64_t seed, std::int64_t range) : random_(seed), range_(range) {}

  std::int64_t integer(std::int64_t low, std::int64_t high) {
    return std::uniform_int_distribution<std::int64_t>(low, high)(random_);
  }
  Eigen::Vector3d point(std::int64_t range) {
    const auto coordinate = [&] { return static_cast<double>(integer(-range, range)); };
    const double x = coordinate();
    const double y = coordinate();
    return {x, y, coordinate()};
  }
  Triangle triangle(std::int64_t range) { return {{point(range), point(range), point(range)}}; }

  TrianglePair pair(Family family) {
    switch (family) {
      case Family::kRandom:
        return {triangle(range_), triangle(range_)};
      case Family::kGrid:
        return {triangle(2), triangle(2)};
      case Family::kNearCoplanar:
        return near_coplanar();
      case Family::kCoplanar:
        return coplanar();
      case Family::kEdgeTouching:
        return edge_touching();
      case Family::kVertexTouching:
        return vertex_touching();
      case Family::kSliver:
        return {sliver(), integer(0, 1) == 0 ? sliver() : triangle(range_)};
      case Family::kDegenerate:
        return degenerate_pair();
    }
    return {};
  }

  /// The six kinds: two equal corners (three ways), all equal, collinear, collinear along an axis.
  Triangle degenerate(std::int64_t kind, std::int64_t range) {
    Triangle t = triangle(range);
    auto& c = t.corner;
    if (kind < 3) {
      c[static_cast<std::size_t>(kind)] = c[static_cast<std::size_t>((kind + 1) % 3)];
    } else if (kind == 3) {
      c[1] = c[2] = c[0];
    } else {
      Eigen::Vector3d step = point(range);
      if (kind == 5) {
        const auto axis = static_cast<Eigen::Index>(integer(0, 2));
        step = step[axis] * Eigen::Vector3d::Unit(axis);
      }
      c[1] = c[0] + static_cast<double>(integer(-3, 3)) * step;
      c[2] = c[0] + static_cast<double>(integer(-3, 3)) * step;
    }
    return t;
  }

 private:
  // Both triangles on one lattice plane through a common point, so exactly coplanar.
  TrianglePair coplanar() {
    const std::int64_t span = integer(0, 1) == 0 ? 4 : range_ / 8;
    const Eigen::Vector3d origin = point(range_);
    const Eigen::Vector3d u = point(range_ / span);
    const Eigen::Vector3d v = point(range_ / span);
    const auto corner = [&]() -> Eigen::Vector3d {
      const auto i = static_cast<double>(integer(-span, span));
      return origin + i * u + static_cast<double>(integer(-span, span)) * v;
    };
    TrianglePair result;
    for (auto& c : result.first.corner) c = corner();
    for (auto& c : result.second.corner) c = corner();
    return result;
  }

  TrianglePair near_coplanar() {
    TrianglePair result = coplanar();
    for (auto& c : result.second.corner) c += point(1);
    return result;
  }

  // A corner or an edge of the second triangle passes through a lattice point on an edge of the
  // first; half of the time the edge lies along the first one's edge.
  TrianglePair edge_touching() {
    TrianglePair result{triangle(range_ / 8), triangle(range_)};
    auto& p = result.first.corner;
    auto& q = result.second.corner;
    const Eigen::Vector3d step = point(range_ / 8);
    p[1] = p[0] + 4 * step;
    const Eigen::Vector3d touched = p[0] + static_cast<double>(integer(-1, 5)) * step;
    const Eigen::Vector3d along = integer(0, 1) == 0 ? step : point(range_ / 8);
    q[0] = touched - static_cast<double>(integer(0, 2)) * along;
    q[1] = touched + static_cast<double>(integer(0, 2)) * along;
    shuffle(result);
    return result;
  }

  TrianglePair vertex_touching() {
    TrianglePair result{triangle(range_), triangle(range_)};
    const auto corner = [this] { return static_cast<std::size_t>(integer(0, 2)); };
    const std::size_t shared = corner();
    result.second.corner[shared] = result.first.corner[corner()];
    const std::int64_t variant = integer(0, 3);
    if (variant == 0) result.second.corner[corner()] = result.first.corner[corner()];
    if (variant == 1) result.second.corner[shared] += point(1);
    return result;
  }

  Triangle sliver() {
    Triangle t = triangle(range_);
    t.corner[2] = t.corner[0] + Eigen::Vector3d(((t.corner[1] - t.corner[0]) / 2).array().floor());
    t.corner[2] += point(1);
    return t;
  }

  TrianglePair degenerate_pair() {
    const std::int64_t range = integer(0, 1) == 0 ? 2 : range_;
    TrianglePair result{degenerate(integer(0, 5), range), triangle(range)};
    const std::int64_t other = integer(0, 3);
    if (other == 0) result.second = degenerate(integer(0, 5), range);
    if (other == 1) result.second.corner[0] = result.first.corner[0];
    if (other == 2) {  // a corner of the first amid the second
      result.second = triangle(range / 2);
      const auto& q = result.second.corner;
      result.first.corner[0] = 2 * q[0] - q[1];
      result.first.corner[1] = q[1];
      result.first.corner[2] = integer(0, 1) == 0 ? q[1] : Eigen::Vector3d(3 * q[0] - 2 * q[1]);
    }
    if (integer(0, 1) == 0) std::swap(result.first, result.second);
    return result;
  }

  void shuffle(TrianglePair& pair) {
    std::shuffle(pair.first.corner.begin(), pair.first.corner.end(), random_);
    std::shuffle(pair.second.corner.begin(), pair.second.corner.end(), random_);
    if (integer(0, 1) == 0) std::swap(pair.first, pair.second);
  }

  std::mt19937_64 random_;
  std::int64_t range_;
};

}  // namespace boxtree::test
