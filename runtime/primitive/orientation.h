// SPDX-License-Identifier: MIT
// Exact orientation signs: a rounding-error filter, inline, before exact arithmetic, out of line
// (after Shewchuk, "Adaptive Precision Floating-Point Arithmetic", 1997).
#pragma once

#include <cmath>
#include <limits>

#include <Eigen/Core>

#include "runtime/primitive/rounding.h"

namespace boxtree {

// Error bounds of the filters. Let u = 2^-53, and let every operation round with a factor 1 + d,
// |d| <= u. A product of k such factors differs from 1 by at most g(k) = k u / (1 - k u).
//
// orient3d: a term of the determinant is (difference * difference) - ..., times a difference, then
// summed. It passes through 3 differences, 2 products and 3 additions: 8 roundings. So the computed
// determinant is off by at most g(8) S, where S is the exact sum of the terms' magnitudes. The
// computed sum S' of the same rounded terms obeys S <= (1 + g(8)) S', and multiplying S' by the
// constant rounds once more: |error| <= g(8) (1 + g(8)) (1 + u) S' < (8 u + 256 u^2) S'.
// orient2d: 2 differences, 1 product, 1 subtraction: 4 roundings, hence (4 u + 64 u^2).
//
// Underflow adds at most 2^-1075 per product, which the second product of orient3d multiplies by a
// difference of at most 2^201: less than 2^-860 in all, for coordinates up to 2^200.
inline constexpr double kOrient3dBound = (8 + 256 * kRoundoffF64) * kRoundoffF64;
inline constexpr double kOrient2dBound = (4 + 64 * kRoundoffF64) * kRoundoffF64;
inline constexpr double kOrientUnderflow = 0x1p-860;

/// orient3d and orient2d by expansion arithmetic alone, some 100 times slower.
[[nodiscard]] int orient3d_exact(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                 const Eigen::Vector3d& c, const Eigen::Vector3d& d) noexcept;
[[nodiscard]] int orient2d_exact(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                 const Eigen::Vector2d& c) noexcept;

/// Sign (-1, 0, +1) of the volume of the tetrahedron a, b, c, d: positive when d lies below the
/// plane through a, b, c seen counter-clockwise from above.
/// Exact for all coordinates up to 2^200.
[[nodiscard]] inline int orient3d(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                  const Eigen::Vector3d& c, const Eigen::Vector3d& d) noexcept {
  const double ax = a[0] - d[0], ay = a[1] - d[1], az = a[2] - d[2];
  const double bx = b[0] - d[0], by = b[1] - d[1], bz = b[2] - d[2];
  const double cx = c[0] - d[0], cy = c[1] - d[1], cz = c[2] - d[2];
  const double bxcy = bx * cy, cxby = cx * by;
  const double cxay = cx * ay, axcy = ax * cy;
  const double axby = ax * by, bxay = bx * ay;
  const double determinant = (az * (bxcy - cxby) + bz * (cxay - axcy)) + cz * (axby - bxay);
  const double magnitude = (std::abs(az) * (std::abs(bxcy) + std::abs(cxby)) +
                            std::abs(bz) * (std::abs(cxay) + std::abs(axcy))) +
                           std::abs(cz) * (std::abs(axby) + std::abs(bxay));
  const double bound = kOrient3dBound * magnitude + kOrientUnderflow;
  if (determinant > bound) return 1;
  if (determinant < -bound) return -1;
  return orient3d_exact(a, b, c, d);
}

/// orient2d where doubles decide it, otherwise 0.
[[nodiscard]] inline int orient2d_filter(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                         const Eigen::Vector2d& c) noexcept {
  const double left = (a[0] - c[0]) * (b[1] - c[1]);
  const double right = (a[1] - c[1]) * (b[0] - c[0]);
  const double determinant = left - right;
  const double bound = kOrient2dBound * (std::abs(left) + std::abs(right)) + kOrientUnderflow;
  if (determinant > bound) return 1;
  return determinant < -bound ? -1 : 0;
}

/// Sign of twice the area of a, b, c: positive when they turn counter-clockwise. Exact as orient3d.
[[nodiscard]] inline int orient2d(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                  const Eigen::Vector2d& c) noexcept {
  const int sign = orient2d_filter(a, b, c);
  return sign != 0 ? sign : orient2d_exact(a, b, c);
}

}  // namespace boxtree
