// SPDX-License-Identifier: MIT
// The exact half of the orientation predicates: expansion arithmetic of fixed size on the stack.
#include <algorithm>

#include <boxtree/runtime/primitive/expansion.h>
#include <boxtree/runtime/primitive/orientation.h>

namespace boxtree {
namespace {

template <class Vector>
double largest_magnitude(const Vector& v) {
  return v.cwiseAbs().maxCoeff();
}

// x1 y2 - x2 y1
Expansion<16> exact_minor(const Expansion<2>& x1, const Expansion<2>& y1, const Expansion<2>& x2,
                          const Expansion<2>& y2) {
  return x1 * y2 - x2 * y1;
}

// Coordinates of up to some 25 bits, as grids and most floats have, make differences, products and
// minors that are exact doubles. Then three products are all there is to add up.
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
  const double scale = safe_scale(std::max(
      {largest_magnitude(a), largest_magnitude(b), largest_magnitude(c), largest_magnitude(d)}));
  const auto difference = [scale, &d](const Eigen::Vector3d& v, Eigen::Index axis) {
    return exact_difference(scale * v[axis], scale * d[axis]);
  };
  // Differences are mostly exact doubles; each expansion is then half as long, or shorter still.
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
  const double scale =
      safe_scale(std::max({largest_magnitude(a), largest_magnitude(b), largest_magnitude(c)}));
  const auto difference = [scale, &c](const Eigen::Vector2d& v, Eigen::Index axis) {
    return exact_difference(scale * v[axis], scale * c[axis]);
  };
  return exact_minor(difference(a, 0), difference(a, 1), difference(b, 0), difference(b, 1)).sign();
}

}  // namespace boxtree
