// SPDX-License-Identifier: MIT
// Normals.
#include "runtime/primitive/normal.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "runtime/primitive/expansion.h"
#include "runtime/primitive/vector3.h"

namespace boxtree {
namespace {

// x brought to a largest coordinate in [1/2, 1), which squares and roots bear.
Eigen::Vector3d scaled_to_one(const Eigen::Vector3d& x, double largest) noexcept {
  const int exponent = -1 - std::ilogb(largest);
  return {std::ldexp(x[0], exponent), std::ldexp(x[1], exponent), std::ldexp(x[2], exponent)};
}

Eigen::Vector3d normalised(const Eigen::Vector3d& x) noexcept {
  const double largest = x.cwiseAbs().maxCoeff();
  if (!(largest > 0)) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d scaled = scaled_to_one(x, largest);
  return scaled / std::sqrt(squared_length(scaled));
}

}  // namespace

// With u = 2^-53: an edge is a sum of two doubles, exactly. Of their products the two largest parts
// are exact, and what is left is below u^2 of the edges' largest coordinates each time it is
// rounded: each coordinate of the cross product is off by less than 2^-102 of their product. Scaled
// so that no part of weight underflows.
Eigen::Vector3d unit_normal(const Triangle& triangle) noexcept {
  double largest = 0;
  for (const Eigen::Vector3d& corner : triangle.corner) {
    largest = std::max(largest, corner.cwiseAbs().maxCoeff());
  }
  const double scale = safe_scale(largest);
  Rounded first[3], second[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    const double from = -scale * triangle.corner[0][axis];
    first[k] = two_sum(scale * triangle.corner[1][axis], from);
    second[k] = two_sum(scale * triangle.corner[2][axis], from);
  }
  Eigen::Vector3d normal;
  for (std::size_t k = 0; k < 3; ++k) {
    const Rounded &a = first[(k + 1) % 3], &b = second[(k + 2) % 3];
    const Rounded &c = first[(k + 2) % 3], &d = second[(k + 1) % 3];
    const Rounded ab = two_product(a.value, b.value), cd = two_product(c.value, d.value);
    const Rounded difference = two_sum(ab.value, -cd.value);
    const double rest =
        (a.value * b.error + a.error * b.value) - (c.value * d.error + c.error * d.value);
    normal[static_cast<Eigen::Index>(k)] =
        difference.value + (difference.error + ((ab.error - cd.error) + rest));
  }
  return normalised(normal);
}

Eigen::Vector3d placed_normal(const Eigen::Matrix3d& linear,
                              const Eigen::Vector3d& normal) noexcept {
  const double largest = linear.cwiseAbs().maxCoeff();
  if (!(largest > 0)) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d x = scaled_to_one(linear.col(0), largest);
  const Eigen::Vector3d y = scaled_to_one(linear.col(1), largest);
  const Eigen::Vector3d z = scaled_to_one(linear.col(2), largest);
  // The cross product of two images is the cofactor matrix times that of the originals, and a
  // mirror turns it over.
  Eigen::Matrix3d cofactors;
  cofactors << cross(y, z), cross(z, x), cross(x, y);
  const double determinant = dot(x, cofactors.col(0));
  const Eigen::Vector3d placed = normalised(product(cofactors, normal));
  return determinant < 0 ? Eigen::Vector3d(-placed) : placed;
}

}  // namespace boxtree
