// SPDX-License-Identifier: MIT
// An exact overlap oracle that shares no idea with the code under test: two convex hulls meet if
// and only if the origin is in the hull of the differences of their corners, and then
// (Caratheodory) in a simplex of at most four of them. All such simplices are tried, in integer
// arithmetic.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace boxtree::test {

__extension__ typedef __int128 Int128;

struct IntVector {
  std::int64_t x, y, z;
};

inline IntVector to_integer(const Eigen::Vector3d& v) {
  return {static_cast<std::int64_t>(v[0]), static_cast<std::int64_t>(v[1]),
          static_cast<std::int64_t>(v[2])};
}

inline int sign_of(Int128 value) {
  return value > 0 ? 1 : (value < 0 ? -1 : 0);
}

// Coordinates below 2^40: the determinant stays below 6 * 2^120.
inline int determinant_sign(const IntVector& a, const IntVector& b, const IntVector& c) {
  const auto minor = [](std::int64_t p, std::int64_t q, std::int64_t r, std::int64_t s) {
    return Int128(p) * s - Int128(q) * r;
  };
  return sign_of(minor(a.x, a.y, b.x, b.y) * c.z + minor(a.y, a.z, b.y, b.z) * c.x -
                 minor(a.x, a.z, b.x, b.z) * c.y);
}

inline std::array<int, 3> cross_signs(const IntVector& a, const IntVector& b) {
  return {sign_of(Int128(a.y) * b.z - Int128(a.z) * b.y),
          sign_of(Int128(a.z) * b.x - Int128(a.x) * b.z),
          sign_of(Int128(a.x) * b.y - Int128(a.y) * b.x)};
}

inline bool segment_has_origin(const IntVector& a, const IntVector& b) {
  return cross_signs(a, b) == std::array{0, 0, 0} &&
         Int128(a.x) * b.x + Int128(a.y) * b.y + Int128(a.z) * b.z <= 0;
}

// With the origin in their plane, it is inside if the three cross products, all parallel, do not
// point both ways. Degenerate triangles are left to their edges.
inline bool triangle_has_origin(const IntVector& a, const IntVector& b, const IntVector& c) {
  if (determinant_sign(a, b, c) != 0) return false;
  const std::array<std::array<int, 3>, 3> crosses = {cross_signs(a, b), cross_signs(b, c),
                                                     cross_signs(c, a)};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int s0 = crosses[0][axis], s1 = crosses[1][axis], s2 = crosses[2][axis];
    if (s0 != 0 && s0 == s1 && s0 == s2) return true;
  }
  return false;
}

inline bool tetrahedron_has_origin(const IntVector& a, const IntVector& b, const IntVector& c,
                                   const IntVector& d) {
  const int s = determinant_sign(b, c, d);
  return s != 0 && determinant_sign(a, c, d) == -s && determinant_sign(a, b, d) == s &&
         determinant_sign(a, b, c) == -s;
}

/// Whether the hulls of two sets of integer points share a point.
inline bool hulls_intersect(std::span<const IntVector> p, std::span<const IntVector> q) {
  std::vector<IntVector> d;
  for (const IntVector& a : p) {
    for (const IntVector& b : q) d.push_back({a.x - b.x, a.y - b.y, a.z - b.z});
  }
  for (std::size_t i = 0; i < d.size(); ++i) {
    if (d[i].x == 0 && d[i].y == 0 && d[i].z == 0) return true;
    for (std::size_t j = 0; j < i; ++j) {
      if (segment_has_origin(d[i], d[j])) return true;
      for (std::size_t k = 0; k < j; ++k) {
        if (triangle_has_origin(d[i], d[j], d[k])) return true;
        for (std::size_t l = 0; l < k; ++l) {
          if (tetrahedron_has_origin(d[i], d[j], d[k], d[l])) return true;
        }
      }
    }
  }
  return false;
}

}  // namespace boxtree::test
