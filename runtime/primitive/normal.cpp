// SPDX-License-Identifier: MIT
// Normals.
#include "runtime/primitive/normal.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "runtime/primitive/expansion.h"
#include "runtime/primitive/vector3.h"

namespace boxtree {
namespace {

// The power of two that scales a number into [1, 2), where squares and roots are safe; subnormal
// numbers come as near as a finite power brings them. Precondition: x > 0, and below 2^1023.
double power_to_one(double x) noexcept {
  return std::bit_cast<double>((kTwiceBias - (std::bit_cast<std::uint64_t>(x) >> 52)) << 52);
}

Eigen::Vector3d normalised(const Eigen::Vector3d& x) noexcept {
  const double largest = x.cwiseAbs().maxCoeff();
  if (!(largest > 0)) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d scaled = power_to_one(largest) * x;
  return scaled / std::sqrt(squared_length(scaled));
}

}  // namespace

// Let u = 2^-53. An edge is exactly a sum of two doubles. In double alone a coordinate of the cross
// product is off by less than 8 u of the product of the edges' largest coordinates, which matters
// only if the corners are nearly collinear. Then it is computed again: the two largest parts of the
// products are exact, and each rounding of the rest is below u^2, 2^-102 of that product in all.
// Coordinates are scaled so that no significant part underflows.
Eigen::Vector3d unit_normal(const Triangle& triangle) noexcept {
  double largest = std::numeric_limits<double>::min();
  for (const Eigen::Vector3d& corner : triangle.corner) {
    largest = std::max(largest, corner.cwiseAbs().maxCoeff());
  }
  const double scale = power_to_one(largest);
  const Eigen::Vector3d at = scale * triangle.corner[0];
  const Eigen::Vector3d to_first = scale * triangle.corner[1],
                        to_second = scale * triangle.corner[2];
  const Eigen::Vector3d first = to_first - at, second = to_second - at;
  Eigen::Vector3d normal = cross(first, second);
  const double product = first.cwiseAbs().maxCoeff() * second.cwiseAbs().maxCoeff();
  if (normal.cwiseAbs().maxCoeff() < product * kNearlyCollinear) [[unlikely]] {
    for (Eigen::Index k = 0; k < 3; ++k) {
      const Eigen::Index i = (k + 1) % 3, j = (k + 2) % 3;
      const Rounded a = two_sum(to_first[i], -at[i]), b = two_sum(to_second[j], -at[j]);
      const Rounded c = two_sum(to_first[j], -at[j]), d = two_sum(to_second[i], -at[i]);
      const Rounded ab = two_product(a.value, b.value), cd = two_product(c.value, d.value);
      const Rounded difference = two_sum(ab.value, -cd.value);
      const double rest =
          (a.value * b.error + a.error * b.value) - (c.value * d.error + c.error * d.value);
      normal[k] = difference.value + (difference.error + ((ab.error - cd.error) + rest));
    }
  }
  return normalised(normal);
}

Eigen::Vector3d unit_across(const Eigen::Vector3d& along) noexcept {
  Eigen::Index smallest = 0;
  static_cast<void>(along.cwiseAbs().minCoeff(&smallest));
  const Eigen::Vector3d other = Eigen::Vector3d::Unit(smallest);
  const Eigen::Vector3d across = unit_normal({{Eigen::Vector3d::Zero(), along, other}});
  return across.isZero(0) ? other : across;
}

namespace {

// Whether it scales alone, by one number on all axes: normals then keep their bits.
bool keeps_directions(const Eigen::Matrix3d& linear) noexcept {
  const double scale = linear(0, 0);
  return scale > 0 && linear(1, 1) == scale && linear(2, 2) == scale && linear(0, 1) == 0 &&
         linear(0, 2) == 0 && linear(1, 0) == 0 && linear(1, 2) == 0 && linear(2, 0) == 0 &&
         linear(2, 1) == 0;
}

// The cofactors of a matrix, and the sign of its determinant, but for a factor.
struct Cofactors {
  explicit Cofactors(const Eigen::Matrix3d& linear) noexcept {
    const double largest = linear.cwiseAbs().maxCoeff();
    if (!(largest > 0)) return;
    const Eigen::Matrix3d scaled = power_to_one(largest) * linear;
    const Eigen::Vector3d x = scaled.col(0), y = scaled.col(1), z = scaled.col(2);
    matrix << cross(y, z), cross(z, x), cross(x, y);
    determinant = dot(x, matrix.col(0));
  }

  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  double determinant = 0;
};

}  // namespace

bool is_mirror(const Eigen::Matrix3d& linear) noexcept {
  return Cofactors(linear).determinant < 0;
}

// The cross product of two images is the cofactor matrix times that of the originals; a mirror
// reverses it.
Eigen::Vector3d placed_normal(const Eigen::Matrix3d& linear,
                              const Eigen::Vector3d& normal) noexcept {
  if (keeps_directions(linear)) return normal;
  const Cofactors cofactors(linear);
  const Eigen::Vector3d placed = normalised(product(cofactors.matrix, normal));
  return cofactors.determinant < 0 ? Eigen::Vector3d(-placed) : placed;
}

}  // namespace boxtree
