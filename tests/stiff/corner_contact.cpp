// SPDX-License-Identifier: MIT
// Nearest point of triangles to a corner. Over a face, height and normal are the plane's, so that
// depths far below the rounding of a difference of points keep their direction.
#include "tests/stiff/corner_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace boxtree::stiff {
namespace {

bool is_over(const WorldTriangle& triangle, const Eigen::Vector3d& point) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d& a = triangle.corner[i];
    const Eigen::Vector3d& b = triangle.corner[(i + 1) % 3];
    if ((b - a).cross(point - a).dot(triangle.normal) < 0) return false;
  }
  return true;
}

// From `point` to the nearest point of the triangle's edges.
Eigen::Vector3d to_nearest_edge(const WorldTriangle& triangle, const Eigen::Vector3d& point) {
  Eigen::Vector3d nearest = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d from = triangle.corner[i] - point;
    const Eigen::Vector3d edge = triangle.corner[(i + 1) % 3] - triangle.corner[i];
    const double along = std::clamp(-from.dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    const Eigen::Vector3d way = from + along * edge;
    if (way.squaredNorm() < nearest.squaredNorm()) nearest = way;
  }
  return nearest;
}

}  // namespace

void place(const Shape& shape, std::span<const std::uint32_t> faces, const Pose* pose,
           std::vector<WorldTriangle>& out) {
  out.clear();
  for (const std::uint32_t face : faces) {
    for (const Triangle& triangle : shape.face(face)) {
      WorldTriangle placed{triangle.corner, {}};
      if (pose != nullptr) {
        for (Eigen::Vector3d& corner : placed.corner) corner = *pose * corner;
      }
      const Eigen::Vector3d area =
          (placed.corner[1] - placed.corner[0]).cross(placed.corner[2] - placed.corner[0]);
      const double length = area.norm();
      if (!(length > 0)) continue;
      placed.normal = area / length;
      out.push_back(placed);
    }
  }
}

std::optional<Depth> depth_of(const Eigen::Vector3d& point,
                              std::span<const WorldTriangle> triangles, double limit) {
  double nearest = std::numeric_limits<double>::infinity();
  std::optional<Depth> result;
  for (const WorldTriangle& triangle : triangles) {
    const double height = triangle.normal.dot(point - triangle.corner[0]);
    if (std::abs(height) >= nearest) continue;
    Depth here{-height, triangle.normal, false};
    double distance = std::abs(height);
    if (!is_over(triangle, point)) {
      const Eigen::Vector3d way = to_nearest_edge(triangle, point);
      distance = way.norm();
      if (!(distance < nearest)) continue;
      if (distance > 0) here = {distance, way / distance, true};
    }
    nearest = distance;
    result.reset();
    if (height < 0 && distance <= limit) result = here;
  }
  return result;
}

}  // namespace boxtree::stiff
