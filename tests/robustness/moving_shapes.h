// SPDX-License-Identifier: MIT
// Shapes that move: what is cast, and touches where it starts.
#pragma once

#include <utility>
#include <variant>
#include <vector>

#include <boxtree/cast.h>
#include <boxtree/collide.h>

namespace boxtree::robustness {

/// A convex hull that owns its points.
struct Hull {
  std::vector<Eigen::Vector3d> points;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  decltype(ConvexHull::rotation) rotation{1, 0, 0, 0};

  [[nodiscard]] ConvexHull view() const { return {points, position, rotation}; }
};

using Shape = std::variant<Sphere, Capsule, OrientedBox, Hull>;

/// In object space.
struct Cast {
  Shape shape;
  Motion motion;
};

/// Calls body with the shape as queries take it.
template <class Body>
decltype(auto) with_shape(const Shape& shape, Body body) {
  return std::visit(
      [&]<class S>(const S& held) {
        if constexpr (std::is_same_v<S, Hull>) {
          return body(held.view());
        } else {
          return body(held);
        }
      },
      shape);
}

/// The position of a shape: of a capsule that of its middle.
[[nodiscard]] Eigen::Vector3d position_of(const Shape& shape);
/// The shape with that position.
[[nodiscard]] Shape moved_to(Shape shape, const Eigen::Vector3d& position);
/// The shape with all lengths, its position too, times a factor.
[[nodiscard]] Shape times(Shape shape, double factor);

/// One of each kind, around the origin, which reaches as far as `half` along the axes: a sphere of
/// its first number, a capsule along the longest axis, a box, its corners as a hull, and an
/// octahedron.
[[nodiscard]] std::vector<Shape> shapes_of(const Eigen::Vector3d& half);
[[nodiscard]] const char* name_of(const Shape& shape);

}  // namespace boxtree::robustness
