// SPDX-License-Identifier: MIT
// The least of the distances to part along the directions in which two convex shapes can leave each
// other: the normals of their Minkowski difference, which is a polytope for a segment or a box (van
// den Bergen, "Proximity Queries and Penetration Depth Computation on 3D Game Objects", 2001).
#include "runtime/primitive/penetration.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/primitive/box_axes.h"
#include "runtime/primitive/closest_point.h"
#include "runtime/primitive/normal.h"
#include "runtime/primitive/rounding.h"
#include "runtime/primitive/separation.h"
#include "runtime/primitive/vector3.h"

namespace boxtree {
namespace {

// The direction along which a core leaves a triangle soonest, of those that are tried; an earlier
// one wins unless a later one is better by more than rounding.
class LeastDepth {
 public:
  LeastDepth(const ConvexShape& shape, const Corners& corner, double doubt) noexcept
      : shape_(shape), corner_(corner), error_(4 * doubt + kDepthError * max_abs_of(corner)) {}

  // Along a vector of length 1, either way, or 0: then it is none. A call, for its size: most
  // contacts try one.
  [[gnu::noinline]] void try_axis(const Eigen::Vector3d& axis) noexcept {
    if (axis.isZero(0)) return;
    const auto [low, high, half] = project(axis, shape_, corner_);
    // Beyond the triangle's high side, or its low one.
    try_depths(axis, high + half, half - low);
  }
  // Whether it leaves soonest along an axis, `along` it or `against` it.
  [[nodiscard]] bool is_deeper(double along, double against) const noexcept {
    return std::min(along, against) < depth - error_;
  }
  void try_depths(const Eigen::Vector3d& axis, double along, double against) noexcept {
    if (along < depth - error_) {
      depth = along;
      normal = axis;
    }
    if (against < depth - error_) {
      depth = against;
      normal = -axis;
    }
  }

  void try_all() noexcept {
    const Corners edge = edges_of(corner_);
    const Eigen::Vector3d of_face = unit_normal({corner_});
    has_area = !of_face.isZero(0);
    try_axis(of_face);
    for (const Eigen::Vector3d& of_triangle : edge) {
      for (std::uint32_t k = 0; k < shape_.axes; ++k) {
        try_axis(unit_normal({{Eigen::Vector3d::Zero(), of_triangle, shape_.axis[k]}}));
      }
    }
  }

  // Along a line between the two, made orthogonal to what it may start or end on: near each other,
  // rounding tilts it, and an edge sticks out by as much of its length.
  void try_across(const Eigen::Vector3d& between) noexcept {
    const auto try_one = [&](const Eigen::Vector3d& along) {
      const double square = squared_length(along);
      if (!(square > 0)) return;
      const Eigen::Vector3d across = between - (dot(between, along) / square) * along;
      const double length = std::sqrt(squared_length(across));
      if (length > 0) try_axis(across / length);
    };
    for (const Eigen::Vector3d& of_triangle : edges_of(corner_)) try_one(of_triangle);
    for (std::uint32_t k = 0; k < shape_.axes; ++k) try_one(shape_.axis[k]);
  }

  double depth = std::numeric_limits<double>::infinity();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  bool has_area = true;  // the triangle, as try_all() found it
  [[nodiscard]] double error() const noexcept { return error_; }

 private:
  const ConvexShape& shape_;
  const Corners& corner_;
  double error_;
};

// Nothing where an axis shows a gap of more than `apart`.
std::optional<Penetration> of_box(const ConvexShape& box, BoxAxes& axes, const Corners& corner,
                                  double doubt, double apart) noexcept {
  LeastDepth least(box, corner, doubt);
  least.try_axis(unit_normal({corner}));
  const double depth_of_face = least.depth;
  for (std::size_t group = 0; group < BoxAxes::kGroups; ++group) {
    const BoxOverlaps overlaps = axes.overlaps(group);
    for (std::size_t k = 0; k < BoxAxes::count(group); ++k) {
      const double first = overlaps.first[k], last = overlaps.last[k];
      if (!(first <= apart && last >= -apart)) return std::nullopt;
      if (least.is_deeper(last, -first)) least.try_depths(axes.axis(group, k), last, -first);
    }
  }
  // Any but that of the face is in the frame of the box.
  if (least.depth != depth_of_face) least.normal = from_frame_of(box, least.normal);
  return Penetration{point_inside_box(box, least.error(), corner), least.normal,
                     std::max(0.0, least.depth),
                     // Where the box leaves it.
                     farthest_feature(least.normal, corner, least.error())};
}

}  // namespace

Penetration penetration(const ConvexShape& shape, const Corners& corner, double doubt) noexcept {
  if (shape.hull != nullptr) {
    return shape.hull->penetration(shape.hull->point, corner, doubt, nullptr);
  }
  if (shape.axes == 3) {
    const Triangle triangle{corner};
    BoxAxes axes(shape, triangle, corner, Eigen::Vector3d::Zero());
    return *of_box(shape, axes, corner, doubt, std::numeric_limits<double>::infinity());
  }
  return penetration_of_core(shape, corner, doubt, contact_points(shape, corner));
}

std::optional<Penetration> box_penetration(const ConvexShape& box, const Triangle& triangle,
                                           const Corners& corner, double doubt) noexcept {
  BoxAxes axes(box, triangle, corner, Eigen::Vector3d::Zero());
  return of_box(box, axes, corner, doubt, axes.error() + 2 * doubt);
}

Penetration penetration_of_core(const ConvexShape& shape, const Corners& corner, double doubt,
                                const ClosestPoints& points) noexcept {
  const Eigen::Vector3d& core = points.core;
  // Of a sphere they are that already.
  const Eigen::Vector3d closest =
      shape.axes == 0 ? points.between : closest_point_on_triangle(core, {corner});
  const Eigen::Vector3d between = core - closest;
  const double length = std::sqrt(squared_length(between));
  LeastDepth least(shape, corner, doubt);
  if (length > 2 * doubt) least.try_axis(between / length);
  // Rounding tilts the line between points that are near each other, or decides which way it
  // points: then other directions are better.
  if (!(least.depth <= least.error() - length)) {
    least.try_across(between);
    least.try_all();
  }
  if (least.normal.isZero(0) || (least.depth > least.error() && !least.has_area)) {
    // A core along a face without area: any direction across both, of which one may be a place.
    Eigen::Vector3d along = shape.axis[0];
    for (const Eigen::Vector3d& edge : edges_of(corner)) {
      if (squared_length(along) < squared_length(edge)) along = edge;
    }
    least.normal = unit_across(along);
    least.depth = 0;
  }
  return {closest, least.normal, std::max(0.0, shape.radius + least.depth),
          feature_of(core, corner, closest)};
}

}  // namespace boxtree
