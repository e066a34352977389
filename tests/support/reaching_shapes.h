// SPDX-License-Identifier: MIT
// Shapes that reach a point, or hardly do, in random places about it.
#pragma once

#include <algorithm>
#include <random>

#include <Eigen/Geometry>

#include <boxtree/shape.h>

namespace boxtree::test {

class ReachingShapes {
 public:
  explicit ReachingShapes(std::mt19937_64& random) : random_(random) {}

  double unit() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  Eigen::Vector3d vector() { return {unit(), unit(), unit()}; }

  /// Shapes of about a size. `more`: how much more than it takes to reach the point; with 1 it is
  /// on the surface, up to rounding.
  Capsule capsule(const Eigen::Vector3d& point, double size, double more) {
    const Eigen::Vector3d start = point + size * vector(), along = size * vector();
    const double where = std::clamp((point - start).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return {start, start + along, more * (point - start - where * along).norm()};
  }
  OrientedBox box(const Eigen::Vector3d& point, double size, double more) {
    OrientedBox box;
    box.rotation = Eigen::Quaterniond(unit(), unit(), unit(), unit()).normalized();
    box.half_extents = size * vector().cwiseAbs();
    Eigen::Vector3d inside = box.half_extents.cwiseProduct(vector());
    const auto side = static_cast<Eigen::Index>(random_() % 3);
    inside[side] = more * box.half_extents[side];
    box.center = point - box.rotation.toRotationMatrix() * inside;
    return box;
  }

 private:
  std::mt19937_64& random_;
};

}  // namespace boxtree::test
