// SPDX-License-Identifier: MIT
// Separating axes of a triangle and a box (Akenine-Moller, "Fast 3D Triangle-Box Overlap Testing",
// 2001): rounded axes decide nearly all cases, exact signs the rest.
//
// Why rounding rejects no contact. Any vector of doubles is a valid axis: an error in an edge or a
// normal only makes it separate less well. What must be bounded is the error of projecting on it.
// Let u = 2^-53, let c be the computed center (any point will do), x a corner, v = fl(x - c), a the
// axis.
//   - fl(a . v) passes through 1 difference, 1 product and 2 sums: it differs from a . (x - c)
//     by at most 4 u (1 + O(u)) sum |a_k| |v_k| < 5 u sum |a_k| |v_k|.
//   - [low, high] lies in c +- h (1 + 2 u), h = max(fl(high - c), fl(c - low)).
//   - The radius is summed from |a_k| H_k, H_k = fl(fl(g h_k) + fl(8 u max |v_k|)): 2 roundings in
//     H_k and 3 in the sum, each by a factor of at least 1 - u.
// With g = 1 + 8 u: (1 - u)^5 g > 1 + 2 u and (1 - u)^5 8 u > 5 u, so the radius exceeds that of
// the box by more than the error of the projections. Underflow takes at most 2^-1074 from each of
// the products; a last addition covers them.
//
// Why rounding invents no contact. Let a* be the exact axis, M = max_k (h_k + max |v_k|), d the
// largest difference between the distances from c to two opposite sides of the box, which are at
// least h_k - d. The edges of the given corners are within u of a*, per component. Then
//   - a* . (x - c) differs from fl(a . v) by at most 7 u |a|_1 M,
//   - the radius computed exceeds that of the box along a* by at most |a|_1 (34 u M + (1 + u) d)
//     and kUnderflow,
// 64 u M + 2 d per unit of |a|_1 exceeds both. Let L be the longest component of two edges: a
// component of their product is at most 2 L L, and off by at most 10 u L L, which adds at most 60 u
// L L M to both: 8 L L for |a|_1 exceeds all of it if L is at least 2^-300, so that nothing
// underflows. Up to M = 2^300 nothing overflows. A triangle and a box that overlap along all axes
// of the theorem intersect; a degenerate triangle has fewer axes.
#include "runtime/primitive/triangle_box.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "runtime/primitive/orientation.h"
#include "runtime/primitive/rounding.h"
#include "runtime/primitive/vector3.h"

namespace boxtree {
namespace {

constexpr double kGrow = 1 + 8 * kRoundoffF64;
constexpr double kSlabError = 8 * kRoundoffF64;
constexpr double kUnderflow = 0x1p-1068;
constexpr double kTwoSums = 4 * kUnderflow;  // lost in the radius and in a projection
constexpr double kOverlapError = 64 * kRoundoffF64;
constexpr double kLargestSure = 0x1p300;
constexpr double kShortestSure = 0x1p-300;

// The box is exact here: no arithmetic, only comparisons.
bool bounds_apart(const Triangle& t, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  bool apart = false;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double a = t.corner[0][k], b = t.corner[1][k], c = t.corner[2][k];
    apart |= std::min(std::min(a, b), c) > high[k] || std::max(std::max(a, b), c) < low[k];
  }
  return apart;
}

// The triangle relative to the center of the box, and the half extents H_k of the derivation above.
class RoundedAxes {
 public:
  RoundedAxes(const Triangle& triangle, const Eigen::Vector3d& low,
              const Eigen::Vector3d& high) noexcept
      : given_(triangle.corner) {
    double size = 0, asymmetry = 0;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const double middle = 0.5 * (low[k] + high[k]);
      double farthest = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        corner_[i][k] = given_[i][k] - middle;
        farthest = std::max(farthest, std::abs(corner_[i][k]));
      }
      const double above = high[k] - middle, below = middle - low[k];
      const double half_extent = std::max(above, below);
      half_[k] = kGrow * half_extent + kSlabError * farthest;
      size = std::max(size, half_extent + farthest);
      asymmetry = std::max(asymmetry, std::abs(above - below));
    }
    slack_ = kOverlapError * size + 2 * asymmetry;
    is_sure_ = size <= kLargestSure;
  }

  // Whether some axis proves that they are disjoint.
  [[nodiscard]] bool separate() noexcept {
    // Edges of the given corners, not of the centered ones: one rounding less.
    const Eigen::Vector3d e0 = given_[1] - given_[0];
    const Eigen::Vector3d e1 = given_[2] - given_[1];
    if (normal_separates(e0, e1)) return true;
    const Eigen::Vector3d e2 = given_[0] - given_[2];
    return edge_separates(e0) || edge_separates(e1) || edge_separates(e2);
  }

  // Whether the two provably overlap, rounding included, along all axes on which separate() found
  // no gap.
  [[nodiscard]] bool are_sure() const noexcept { return is_sure_; }

 private:
  [[nodiscard]] bool interval_separates(double p0, double p1, double p2, double radius,
                                        double doubt) noexcept {
    const double least = std::min(std::min(p0, p1), p2), most = std::max(std::max(p0, p1), p2);
    const double sure = radius - doubt;
    is_sure_ &= least <= sure && most >= -sure;
    return least > radius || most < -radius;
  }

  // The axis unit(I) x edge: its component along I is zero, so two terms are left.
  template <Eigen::Index I>
  [[nodiscard]] bool edge_axis_separates(const Eigen::Vector3d& edge) noexcept {
    constexpr Eigen::Index kJ = (I + 1) % 3;
    constexpr Eigen::Index kK = (I + 2) % 3;
    const double aj = -edge[kK];
    const double ak = edge[kJ];
    const double size_j = std::abs(aj), size_k = std::abs(ak);
    const double radius = (size_j * half_[kJ] + size_k * half_[kK]) + kUnderflow;
    return interval_separates(
        aj * corner_[0][kJ] + ak * corner_[0][kK], aj * corner_[1][kJ] + ak * corner_[1][kK],
        aj * corner_[2][kJ] + ak * corner_[2][kK], radius, (size_j + size_k) * slack_ + kTwoSums);
  }

  [[nodiscard]] bool edge_separates(const Eigen::Vector3d& edge) noexcept {
    return edge_axis_separates<0>(edge) || edge_axis_separates<1>(edge) ||
           edge_axis_separates<2>(edge);
  }

  // All three corners are projected: the computed normal is not quite orthogonal to the triangle.
  [[nodiscard]] bool normal_separates(const Eigen::Vector3d& e0,
                                      const Eigen::Vector3d& e1) noexcept {
    const Eigen::Vector3d axis = cross(e0, e1);
    const auto project = [&axis](const Eigen::Vector3d& v) {
      return (axis[0] * v[0] + axis[1] * v[1]) + axis[2] * v[2];
    };
    const double radius = ((std::abs(axis[0]) * half_[0] + std::abs(axis[1]) * half_[1]) +
                           std::abs(axis[2]) * half_[2]) +
                          kUnderflow;
    const double longest = std::max(e0.cwiseAbs().maxCoeff(), e1.cwiseAbs().maxCoeff());
    is_sure_ &= longest >= kShortestSure;
    return interval_separates(project(corner_[0]), project(corner_[1]), project(corner_[2]), radius,
                              8 * (longest * longest) * slack_);
  }

  const std::array<Eigen::Vector3d, 3>& given_;
  std::array<Eigen::Vector3d, 3> corner_;
  Eigen::Vector3d half_;
  double slack_;
  bool is_sure_;
};

// The same axes by exact signs. A disjoint pair that no axis of the box separates is separated
// along the triangle's normal, or along the product of one of its edges with an axis of the box, on
// the outer side of that edge: other directions are no facets of the Minkowski difference.
// Projected along the axis of the box, the edge is a line, and the whole box lies on the other side
// of it than the third corner; on either side, if that corner is on the line, too.
class ExactAxes {
 public:
  ExactAxes(const Triangle& triangle, const Eigen::Vector3d& low,
            const Eigen::Vector3d& high) noexcept
      : corner_(triangle.corner), low_(low), high_(high) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      winding_[static_cast<std::size_t>(axis)] =
          orient2d(seen(corner_[0], axis), seen(corner_[1], axis), seen(corner_[2], axis));
    }
  }

  [[nodiscard]] bool separate() const noexcept {
    if (normal_separates()) return true;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < 3; ++i) {
        if (edge_separates(corner_[i], corner_[(i + 1) % 3], axis)) return true;
      }
    }
    return false;
  }

 private:
  // A point projected along an axis.
  static Eigen::Vector2d seen(const Eigen::Vector3d& v, Eigen::Index axis) noexcept {
    return {v[(axis + 1) % 3], v[(axis + 2) % 3]};
  }

  // The side of an edge's line on which the whole box lies; 0 if it intersects the line.
  [[nodiscard]] static int side_of_box(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                                       const Eigen::Vector2d& low,
                                       const Eigen::Vector2d& high) noexcept {
    const bool rises = to[0] > from[0], leans = to[1] > from[1];
    const Eigen::Vector2d right(leans ? high[0] : low[0], rises ? low[1] : high[1]);
    const Eigen::Vector2d left(leans ? low[0] : high[0], rises ? high[1] : low[1]);
    if (orient2d(from, to, right) > 0) return 1;
    return orient2d(from, to, left) < 0 ? -1 : 0;
  }

  [[nodiscard]] bool edge_separates(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                    Eigen::Index axis) const noexcept {
    const int side =
        side_of_box(seen(from, axis), seen(to, axis), seen(low_, axis), seen(high_, axis));
    return side != 0 && side != winding_[static_cast<std::size_t>(axis)];
  }

  // The windings are the signs of the normal's components.
  [[nodiscard]] bool normal_separates() const noexcept {
    Eigen::Vector3d above, below;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const bool points_up = winding_[static_cast<std::size_t>(k)] > 0;
      above[k] = points_up ? high_[k] : low_[k];
      below[k] = points_up ? low_[k] : high_[k];
    }
    // orient3d is positive below the plane.
    return orient3d(corner_[0], corner_[1], corner_[2], above) > 0 ||
           orient3d(corner_[0], corner_[1], corner_[2], below) < 0;
  }

  const std::array<Eigen::Vector3d, 3>& corner_;
  const Eigen::Vector3d& low_;
  const Eigen::Vector3d& high_;
  std::array<int, 3> winding_;  // projected along each axis
};

// Where rounding hides it: seldom but where they just touch.
[[gnu::cold, gnu::noinline]] bool are_apart(const Triangle& triangle, const Eigen::Vector3d& low,
                                            const Eigen::Vector3d& high) noexcept {
  return ExactAxes(triangle, low, high).separate();
}

bool has_corner_inside(const Triangle& t, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  for (const Eigen::Vector3d& c : t.corner) {
    if ((c.array() >= low.array()).all() && (c.array() <= high.array()).all()) return true;
  }
  return false;
}

}  // namespace

bool triangle_intersects_box(const Triangle& triangle, const Eigen::Vector3d& low,
                             const Eigen::Vector3d& high) noexcept {
  if (bounds_apart(triangle, low, high)) return false;
  if (has_corner_inside(triangle, low, high)) return true;
  RoundedAxes rounded(triangle, low, high);
  if (rounded.separate()) return false;
  return rounded.are_sure() || !are_apart(triangle, low, high);
}

}  // namespace boxtree
