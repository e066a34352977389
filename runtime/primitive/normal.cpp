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

// Numbers that stay in registers: vectors that are written and read at once, by halves that do not
// match, wait for memory.
struct Components {
  double x, y, z;

  explicit Components(const Eigen::Vector3d& v) noexcept : x(v[0]), y(v[1]), z(v[2]) {}
  Components(double of_x, double of_y, double of_z) noexcept : x(of_x), y(of_y), z(of_z) {}

  [[nodiscard]] double largest() const noexcept {
    return std::max(std::max(std::abs(x), std::abs(y)), std::abs(z));
  }
  [[nodiscard]] Components times(double scale) const noexcept {
    return {scale * x, scale * y, scale * z};
  }
  [[nodiscard]] Components minus(const Components& other) const noexcept {
    return {x - other.x, y - other.y, z - other.z};
  }
};

Eigen::Vector3d normalised(const Components& v) noexcept {
  const double largest = v.largest();
  if (!(largest > 0)) return Eigen::Vector3d::Zero();
  const Components scaled = v.times(power_to_one(largest));
  const double length =
      std::sqrt((scaled.x * scaled.x + scaled.y * scaled.y) + scaled.z * scaled.z);
  return {scaled.x / length, scaled.y / length, scaled.z / length};
}

// Twice the area of a triangle in the plane of two axes, its corners at (x, y), (x1, y1), (x2, y2);
// see unit_normal().
double careful_area(double x, double y, double x1, double y1, double x2, double y2) noexcept {
  const Rounded a = two_sum(x1, -x), b = two_sum(y2, -y);
  const Rounded c = two_sum(y1, -y), d = two_sum(x2, -x);
  const Rounded ab = two_product(a.value, b.value), cd = two_product(c.value, d.value);
  const Rounded difference = two_sum(ab.value, -cd.value);
  const double rest =
      (a.value * b.error + a.error * b.value) - (c.value * d.error + c.error * d.value);
  return difference.value + (difference.error + ((ab.error - cd.error) + rest));
}

}  // namespace

// Let u = 2^-53. An edge is exactly a sum of two doubles. In double alone a coordinate of the cross
// product is off by less than 8 u of the product of the edges' largest coordinates, which matters
// only if the corners are nearly collinear. Then it is computed again: the two largest parts of the
// products are exact, and each rounding of the rest is below u^2, 2^-102 of that product in all.
// Coordinates are scaled so that no significant part underflows.
Eigen::Vector3d unit_normal(const Triangle& triangle) noexcept {
  const Components corner[3] = {Components(triangle.corner[0]), Components(triangle.corner[1]),
                                Components(triangle.corner[2])};
  const double largest =
      std::max(std::max(corner[0].largest(), corner[1].largest()),
               std::max(corner[2].largest(), std::numeric_limits<double>::min()));
  const double scale = power_to_one(largest);
  const Components at = corner[0].times(scale);
  const Components to_first = corner[1].times(scale), to_second = corner[2].times(scale);
  const Components first = to_first.minus(at), second = to_second.minus(at);
  const Components normal = {first.y * second.z - first.z * second.y,
                             first.z * second.x - first.x * second.z,
                             first.x * second.y - first.y * second.x};
  const double product = first.largest() * second.largest();
  if (normal.largest() < product * kNearlyCollinear) [[unlikely]] {
    return normalised({careful_area(at.y, at.z, to_first.y, to_first.z, to_second.y, to_second.z),
                       careful_area(at.z, at.x, to_first.z, to_first.x, to_second.z, to_second.x),
                       careful_area(at.x, at.y, to_first.x, to_first.y, to_second.x, to_second.y)});
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
  const Eigen::Vector3d placed = normalised(Components(product(cofactors.matrix, normal)));
  return cofactors.determinant < 0 ? Eigen::Vector3d(-placed) : placed;
}

}  // namespace boxtree
