// SPDX-License-Identifier: MIT
// One after the other by number, so that callers compile what they do with them once.
#include "runtime/primitive/box_axes.h"

#include <algorithm>
#include <cmath>

#include "runtime/primitive/normal.h"
#include "runtime/primitive/rounding.h"
#include "runtime/primitive/separation.h"

namespace boxtree {
namespace {

// Let R be the largest coordinate of corners and box. One of a corner in the frame is off by 6 u R
// and by twice what the corner is. Axes are orthonormal to within 4 u, so that along a unit vector
// the box ends 21 u R farther out than its halves say, or less. Projections round by 5 u R.
constexpr double kError = 32 * kRoundoffF64;

}  // namespace

Eigen::Vector3d in_frame_of(const ConvexShape& box, const Eigen::Vector3d& v) noexcept {
  return {dot(v, box.axis[0]), dot(v, box.axis[1]), dot(v, box.axis[2])};
}

Eigen::Vector3d from_frame_of(const ConvexShape& box, const Eigen::Vector3d& v) noexcept {
  return v[0] * box.axis[0] + v[1] * box.axis[1] + v[2] * box.axis[2];
}

BoxAxes::BoxAxes(const ConvexShape& box, const Triangle& triangle, const Corners& corner) noexcept
    : box_(box), triangle_(triangle) {
  double size = max_abs_of(corner);
  for (const double half : box.half) size = std::max(size, half);
  error_ = kError * size;
  const Corners edge = edges_of(triangle.corner);
  for (std::size_t i = 0; i < 3; ++i) {
    corner_[i] = in_frame_of(box_, corner[i]);
    edge_[i] = in_frame_of(box_, edge[i]);
  }
}

bool BoxAxes::get(std::uint32_t n, BoxAxis& axis) const noexcept {
  Eigen::Vector3d& along = axis.along;
  if (n < 3) {
    axis.is_more_to_come = n < 2;
    along = Eigen::Vector3d::Unit(n);
  } else if (n == 3) {
    axis.is_more_to_come = false;
    along = in_frame_of(box_, unit_normal(triangle_));
    if (along.isZero(0)) return false;
  } else {
    const std::uint32_t k = (n - 4) % 3, i = (k + 1) % 3, j = (k + 2) % 3;
    const Eigen::Vector3d& edge = edge_[(n - 4) / 3];
    axis.is_more_to_come = k < 2;
    const double square = edge[i] * edge[i] + edge[j] * edge[j];
    if (!(square >= kShortestDirection * kShortestDirection)) return false;
    const double scale = 1 / std::sqrt(square);
    along[k] = 0;
    along[i] = -edge[j] * scale;
    along[j] = edge[i] * scale;
  }
  const double a = dot(along, corner_[0]), b = dot(along, corner_[1]), c = dot(along, corner_[2]);
  axis.low = std::min(a, std::min(b, c));
  axis.high = std::max(a, std::max(b, c));
  axis.half = std::abs(along[0]) * box_.half[0] + std::abs(along[1]) * box_.half[1] +
              std::abs(along[2]) * box_.half[2];
  return true;
}

}  // namespace boxtree
