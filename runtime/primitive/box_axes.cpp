// SPDX-License-Identifier: MIT
// The overlaps of a group, by loops over lanes of one operation each, so that each is vectorised.
// The edges of the triangle are more accurate than differences of corners in the frame.
#include "runtime/primitive/box_axes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/primitive/normal.h"
#include "runtime/primitive/rounding.h"
#include "runtime/primitive/separation.h"

namespace boxtree {
namespace {

constexpr std::size_t kNormal = 3;  // its lane

// Let R be the largest coordinate of corners and box. One of a corner in the frame is off by 6 u R
// and by twice what the corner is. Axes are orthonormal to within 4 u, so that along a unit vector
// the box ends 21 u R farther out than its halves say, or less. Projections round by 5 u R.
double error_of(const ConvexShape& box, const Corners& corner) noexcept {
  constexpr double kError = 32 * kRoundoffF64;
  double size = max_abs_of(corner);
  for (const double half : box.half) size = std::max(size, half);
  return kError * size;
}

}  // namespace

Eigen::Vector3d in_frame_of(const ConvexShape& box, const Eigen::Vector3d& v) noexcept {
  return {dot(v, box.axis[0]), dot(v, box.axis[1]), dot(v, box.axis[2])};
}

Eigen::Vector3d from_frame_of(const ConvexShape& box, const Eigen::Vector3d& v) noexcept {
  return v[0] * box.axis[0] + v[1] * box.axis[1] + v[2] * box.axis[2];
}

BoxOverlaps::BoxOverlaps(const AxisLanes& a, const AxisLanes& b, const AxisLanes& c,
                         const AxisLanes& half, const AxisLanes& moved) noexcept {
  for (std::size_t k = 0; k < AxisLanes::kCount; ++k) {
    const double below = std::min(a[k], std::min(b[k], c[k])) - half[k];
    const double above = std::max(a[k], std::max(b[k], c[k])) + half[k];
    first[k] = moved[k] < 0 ? -above : below;
    last[k] = moved[k] < 0 ? -below : above;
    speed[k] = std::abs(moved[k]);
    against[k] = moved[k] < 0 ? 1 : -1;
  }
}

void BoxOverlaps::drop(std::size_t lane) noexcept {
  first[lane] = -std::numeric_limits<double>::infinity();
  last[lane] = std::numeric_limits<double>::infinity();
  speed[lane] = 0;
}

BoxAxes::Frame::Frame(const ConvexShape& box) noexcept
    : x_(box.axis[0][0], box.axis[1][0], box.axis[2][0]),
      y_(box.axis[0][1], box.axis[1][1], box.axis[2][1]),
      z_(box.axis[0][2], box.axis[1][2], box.axis[2][2]) {}

AxisLanes BoxAxes::Frame::operator()(const Eigen::Vector3d& v) const noexcept {
  AxisLanes out;
  for (std::size_t k = 0; k < AxisLanes::kCount; ++k) {
    out[k] = (v[0] * x_[k] + v[1] * y_[k]) + v[2] * z_[k];
  }
  return out;
}

AxisLanes BoxAxes::sum_of_products(const Turned& a, const Turned& b) noexcept {
  AxisLanes out;
  for (std::size_t k = 0; k < AxisLanes::kCount; ++k) {
    out[k] = a.next[k] * b.next[k] + a.after[k] * b.after[k];
  }
  return out;
}

BoxAxes::BoxAxes(const ConvexShape& box, const Triangle& triangle, const Corners& corner,
                 const Eigen::Vector3d& direction) noexcept
    : frame_(box),
      triangle_(triangle),
      error_(error_of(box, corner)),
      corner_{frame_(corner[0]), frame_(corner[1]), frame_(corner[2])},
      half_(box.half[0], box.half[1], box.half[2]),
      direction_(frame_(direction)),
      turned_corner_{Turned(corner_[0]), Turned(corner_[1]), Turned(corner_[2])},
      turned_half_(half_),
      turned_direction_(direction_) {}

BoxOverlaps BoxAxes::overlaps(std::size_t group) noexcept {
  if (group == 0) return along_axes_and_normal();
  return across_edge(triangle_.corner[group % 3] - triangle_.corner[group - 1]);
}

Eigen::Vector3d BoxAxes::axis(std::size_t group, std::size_t lane) const noexcept {
  if (group == 0 && lane == kNormal) return normal_;
  Eigen::Vector3d out = Eigen::Vector3d::Zero();
  const auto at = [&](std::size_t n) -> double& {
    return out[static_cast<Eigen::Index>((lane + n) % 3)];
  };
  if (group == 0) {
    at(0) = 1;
  } else {
    at(1) = along_.next[lane];
    at(2) = along_.after[lane];
  }
  return out;
}

BoxOverlaps BoxAxes::along_axes_and_normal() noexcept {
  normal_ = frame_(unit_normal(triangle_)).vector();
  const auto with_normal = [this](const AxisLanes& v) {
    return AxisLanes(v[0], v[1], v[2], dot(normal_, v.vector()));
  };
  const AxisLanes half(half_[0], half_[1], half_[2], dot(normal_.cwiseAbs(), half_.vector()));
  BoxOverlaps out(with_normal(corner_[0]), with_normal(corner_[1]), with_normal(corner_[2]), half,
                  with_normal(direction_));
  if (normal_.isZero(0)) out.drop(kNormal);
  return out;
}

BoxOverlaps BoxAxes::across_edge(const Eigen::Vector3d& of_triangle) noexcept {
  const Turned edge(frame_(of_triangle));
  const AxisLanes square = sum_of_products(edge, edge);
  AxisLanes scale;
  for (std::size_t k = 0; k < AxisLanes::kCount; ++k) scale[k] = std::sqrt(square[k]);
  for (std::size_t k = 0; k < AxisLanes::kCount; ++k) scale[k] = 1 / scale[k];
  Turned size;
  for (std::size_t k = 0; k < AxisLanes::kCount; ++k) along_.next[k] = -edge.after[k] * scale[k];
  for (std::size_t k = 0; k < AxisLanes::kCount; ++k) along_.after[k] = edge.next[k] * scale[k];
  for (std::size_t k = 0; k < AxisLanes::kCount; ++k) size.next[k] = std::abs(along_.next[k]);
  for (std::size_t k = 0; k < AxisLanes::kCount; ++k) size.after[k] = std::abs(along_.after[k]);
  BoxOverlaps out(sum_of_products(along_, turned_corner_[0]),
                  sum_of_products(along_, turned_corner_[1]),
                  sum_of_products(along_, turned_corner_[2]), sum_of_products(size, turned_half_),
                  sum_of_products(along_, turned_direction_));
  // Nothing is orthogonal to an edge along an axis.
  constexpr double kLeast = kShortestDirection * kShortestDirection;
  if (!(std::min({square[0], square[1], square[2]}) >= kLeast)) [[unlikely]] {
    for (std::size_t k = 0; k < AxisLanes::kCount; ++k) {
      if (!(square[k] >= kLeast)) out.drop(k);
    }
  }
  return out;
}

}  // namespace boxtree
