// SPDX-License-Identifier: MIT
// The exact half of the orientation predicates: expansion arithmetic of fixed size on the stack.
#include "runtime/primitive/orientation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "runtime/primitive/expansion.h"
#include "runtime/primitive/wide_integer.h"

namespace boxtree {
namespace {

// The largest magnitude of some coordinates, and the smallest that is not zero.
struct Magnitudes {
  template <class Vector>
  void include(const Vector& v) noexcept {
    for (Eigen::Index k = 0; k < v.size(); ++k) {
      const double x = std::abs(v[k]);
      largest = std::max(largest, x);
      if (x > 0) least = std::min(least, x);
      are_finite &= std::isfinite(x);
    }
  }

  // Whether the errors of products of three, scaled by safe_scale, are doubles: scaled coordinates
  // are then multiples of 2^-350, and their products of 2^-1050. Expansions have no room for
  // infinities and NaN; wide integers clamp them.
  [[nodiscard]] bool are_for_expansions() const noexcept {
    constexpr double kRatio = 0x1p-497;  // 2^-550 times the 53 bits of a double
    return are_finite && least >= kRatio * largest;
  }

  double largest = 0;
  double least = std::numeric_limits<double>::infinity();
  bool are_finite = true;
};

// The sign when exponents are farther apart than that.
int orient3d_wide(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                  const Eigen::Vector3d& d) noexcept {
  std::array<std::array<WideDifference, 3>, 3> v;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    v[0][k] = wide_difference(a[axis], d[axis]);
    v[1][k] = wide_difference(b[axis], d[axis]);
    v[2][k] = wide_difference(c[axis], d[axis]);
  }
  const auto term = [&v](std::size_t i) {
    const auto& p = v[(i + 1) % 3];
    const auto& q = v[(i + 2) % 3];
    return (p[0] * q[1] - q[0] * p[1]) * v[i][2];
  };
  return ((term(0) + term(1)) + term(2)).sign();
}

int orient2d_wide(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                  const Eigen::Vector2d& c) noexcept {
  return (wide_difference(a[0], c[0]) * wide_difference(b[1], c[1]) -
          wide_difference(a[1], c[1]) * wide_difference(b[0], c[0]))
      .sign();
}

// x1 y2 - x2 y1
Expansion<16> exact_minor(const Expansion<2>& x1, const Expansion<2>& y1, const Expansion<2>& x2,
                          const Expansion<2>& y2) {
  return x1 * y2 - x2 * y1;
}

// Coordinates of up to about 25 bits, as in grids and most floats, have differences, products and
// minors that are exact in double. Only three products are then left to add.
struct ExactMinor {
  ExactMinor(double x1, double y1, double x2, double y2) noexcept {
    const Rounded left = two_product(x1, y2);
    const Rounded right = two_product(x2, y1);
    const Rounded difference = two_sum(left.value, -right.value);
    value = difference.value;
    is_exact = left.error == 0 && right.error == 0 && difference.error == 0;
  }
  double value;
  bool is_exact;
};

}  // namespace

int orient3d_exact(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                   const Eigen::Vector3d& d) noexcept {
  if (a == d || b == d || c == d || a == b || b == c || c == a) return 0;  // neighbours in a mesh
  Magnitudes magnitudes;
  for (const Eigen::Vector3d* v : {&a, &b, &c, &d}) magnitudes.include(*v);
  if (!magnitudes.are_for_expansions()) return orient3d_wide(a, b, c, d);
  const double scale = safe_scale(magnitudes.largest);
  const auto difference = [scale, &d](const Eigen::Vector3d& v, Eigen::Index axis) {
    return exact_difference(scale * v[axis], scale * d[axis]);
  };
  // Most differences are exact in double; each expansion is then at most half as long.
  const Expansion<2> ax = difference(a, 0), ay = difference(a, 1), az = difference(a, 2);
  const Expansion<2> bx = difference(b, 0), by = difference(b, 1), bz = difference(b, 2);
  const Expansion<2> cx = difference(c, 0), cy = difference(c, 1), cz = difference(c, 2);
  if (ax.size < 2 && ay.size < 2 && az.size < 2 && bx.size < 2 && by.size < 2 && bz.size < 2 &&
      cx.size < 2 && cy.size < 2 && cz.size < 2) {
    const ExactMinor bc(bx.estimate(), by.estimate(), cx.estimate(), cy.estimate());
    const ExactMinor ca(cx.estimate(), cy.estimate(), ax.estimate(), ay.estimate());
    const ExactMinor ab(ax.estimate(), ay.estimate(), bx.estimate(), by.estimate());
    if (bc.is_exact && ca.is_exact && ab.is_exact) {
      return ((exact_product(bc.value, az.estimate()) + exact_product(ca.value, bz.estimate())) +
              exact_product(ab.value, cz.estimate()))
          .sign();
    }
  }
  const Expansion<64> a_term = exact_minor(bx, by, cx, cy) * az;
  const Expansion<64> b_term = exact_minor(cx, cy, ax, ay) * bz;
  const Expansion<64> c_term = exact_minor(ax, ay, bx, by) * cz;
  return ((a_term + b_term) + c_term).sign();
}

int orient2d_exact(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                   const Eigen::Vector2d& c) noexcept {
  Magnitudes magnitudes;
  for (const Eigen::Vector2d* v : {&a, &b, &c}) magnitudes.include(*v);
  if (!magnitudes.are_for_expansions()) return orient2d_wide(a, b, c);
  const double scale = safe_scale(magnitudes.largest);
  const auto difference = [scale, &c](const Eigen::Vector2d& v, Eigen::Index axis) {
    return exact_difference(scale * v[axis], scale * c[axis]);
  };
  return exact_minor(difference(a, 0), difference(a, 1), difference(b, 0), difference(b, 1)).sign();
}

}  // namespace boxtree
