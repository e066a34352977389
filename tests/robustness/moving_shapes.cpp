// SPDX-License-Identifier: MIT
// Makes and moves shapes.
#include "tests/robustness/moving_shapes.h"

#include <array>

namespace boxtree::robustness {

Eigen::Vector3d position_of(const Shape& shape) {
  return std::visit(
      []<class S>(const S& held) -> Eigen::Vector3d {
        if constexpr (std::is_same_v<S, Capsule>) {
          return (held.start + held.end) / 2;
        } else if constexpr (std::is_same_v<S, Hull>) {
          return held.position;
        } else {
          return held.center;
        }
      },
      shape);
}

Shape moved_to(Shape shape, const Eigen::Vector3d& position) {
  std::visit(
      [&]<class S>(S& held) {
        if constexpr (std::is_same_v<S, Capsule>) {
          const Eigen::Vector3d arm = (held.end - held.start) / 2;
          held.start = position - arm;
          held.end = position + arm;
        } else if constexpr (std::is_same_v<S, Hull>) {
          held.position = position;
        } else {
          held.center = position;
        }
      },
      shape);
  return shape;
}

Shape times(Shape shape, double factor) {
  std::visit(
      [&]<class S>(S& held) {
        if constexpr (std::is_same_v<S, Sphere>) {
          held.center *= factor;
          held.radius *= factor;
        } else if constexpr (std::is_same_v<S, Capsule>) {
          held.start *= factor;
          held.end *= factor;
          held.radius *= factor;
        } else if constexpr (std::is_same_v<S, OrientedBox>) {
          held.center *= factor;
          held.half_extents *= factor;
        } else {
          for (Eigen::Vector3d& point : held.points) point *= factor;
          held.position *= factor;
        }
      },
      shape);
  return shape;
}

std::vector<Shape> shapes_of(const Eigen::Vector3d& half) {
  std::vector<Shape> shapes;
  shapes.emplace_back(Sphere{Eigen::Vector3d::Zero(), half[0]});
  Eigen::Index axis = 0;
  const double longest = half.maxCoeff(&axis);
  const double radius = half.minCoeff();
  const Eigen::Vector3d arm = (longest - radius) * Eigen::Vector3d::Unit(axis);
  shapes.emplace_back(Capsule{-arm, arm, radius});
  OrientedBox box;
  box.half_extents = half;
  shapes.emplace_back(box);
  Hull corners, octahedron;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d signs((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1,
                                (i & 4) != 0 ? 1 : -1);
    corners.points.push_back(half.cwiseProduct(signs));
  }
  for (Eigen::Index k = 0; k < 3; ++k) {
    octahedron.points.push_back(half[k] * Eigen::Vector3d::Unit(k));
    octahedron.points.push_back(-half[k] * Eigen::Vector3d::Unit(k));
  }
  shapes.emplace_back(std::move(corners));
  shapes.emplace_back(std::move(octahedron));
  return shapes;
}

const char* name_of(const Shape& shape) {
  constexpr std::array kNames = {"sphere", "capsule", "box", "hull"};
  return kNames[shape.index()];
}

}  // namespace boxtree::robustness
