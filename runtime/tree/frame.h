// SPDX-License-Identifier: MIT
// Object space and tree space: a shift and an exact power-of-two scale (see TreeRecord).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <Eigen/Core>

#include "format/box.h"
#include "runtime/primitive/axis_lanes.h"

namespace boxtree {

/// Converts between the coordinates of the source mesh and those in which boxes are stored. The
/// conversion to tree space is monotone on each axis (one rounded subtraction, one exact scaling),
/// so a point inside an object-space box stays inside its image.
struct Frame {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  double scale = 1;          // tree to object, a power of two
  double inverse_scale = 1;  // object to tree, a power of two
  AxisLanes origin_lanes = AxisLanes(0, 0, 0);

  Frame() = default;
  Frame(const std::array<double, 3>& frame_origin, int scale_exponent)
      : origin(frame_origin[0], frame_origin[1], frame_origin[2]),
        scale(std::ldexp(1.0, scale_exponent)),
        inverse_scale(std::ldexp(1.0, -scale_exponent)),
        origin_lanes(origin) {}

  [[nodiscard]] Eigen::Vector3d to_tree(const Eigen::Vector3d& object) const noexcept {
    return (object - origin) * inverse_scale;
  }
  [[nodiscard]] AxisLanes to_tree_lanes(const AxisLanes& object) const noexcept {
    AxisLanes tree;
    for (std::size_t k = 0; k < AxisLanes::kCount; ++k) {
      tree[k] = (object[k] - origin_lanes[k]) * inverse_scale;
    }
    return tree;
  }
  [[nodiscard]] Eigen::Vector3d to_object(const Eigen::Vector3d& tree) const noexcept {
    return tree * scale + origin;
  }
};

/// Tree-space coordinates beyond this would overflow in the predicates. Boxes of valid files lie
/// far inside: queries beyond are refused or clamped, stored vertices beyond are corrupt.
inline constexpr double kMaxCoordinate = 0x1p200;

[[nodiscard]] inline bool is_within_range(const Eigen::Vector3d& point) noexcept {
  return (point.cwiseAbs().array() <= kMaxCoordinate).all();  // false for NaN
}

/// Largest magnitude of a coordinate of a box, on each axis.
[[nodiscard]] inline Eigen::Vector3d max_abs_of(const Box<double>& box) noexcept {
  Eigen::Vector3d max_abs;
  for (std::size_t k = 0; k < 3; ++k) {
    max_abs[static_cast<Eigen::Index>(k)] = std::max(std::abs(box.low[k]), std::abs(box.high[k]));
  }
  return max_abs;
}

}  // namespace boxtree
