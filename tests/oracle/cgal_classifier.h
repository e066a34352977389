// SPDX-License-Identifier: MIT
// Whether two triangles share a point, as CGAL's kernels tell it: exact rationals classifier,
// doubles are one more library to be classified.
#pragma once

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/intersections.h>
#include <algorithm>
#include <array>
#include <variant>

#include "runtime/primitive/triangle.h"

namespace boxtree::test {

using ExactKernel = CGAL::Exact_predicates_exact_constructions_kernel;

template <class Kernel>
typename Kernel::Point_3 to_cgal(const Eigen::Vector3d& v) {
  return {v[0], v[1], v[2]};
}

// CGAL's overlap tests need proper triangles; a degenerate one is handed over as what it is.
template <class Kernel>
using CgalShape =
    std::variant<typename Kernel::Point_3, typename Kernel::Segment_3, typename Kernel::Triangle_3>;

template <class Kernel>
CgalShape<Kernel> to_cgal(const Triangle& t) {
  std::array<typename Kernel::Point_3, 3> c = {
      to_cgal<Kernel>(t.corner[0]), to_cgal<Kernel>(t.corner[1]), to_cgal<Kernel>(t.corner[2])};
  if (!CGAL::collinear(c[0], c[1], c[2])) return typename Kernel::Triangle_3(c[0], c[1], c[2]);
  std::sort(c.begin(), c.end());
  if (c[0] == c[2]) return c[0];
  return typename Kernel::Segment_3(c[0], c[2]);
}

/// The kernel's answer; exact with ExactKernel.
template <class Kernel>
bool cgal_triangles_intersect(const Triangle& p, const Triangle& q) {
  using Point = typename Kernel::Point_3;
  const auto intersect = []<class A, class B>(const A& a, const B& b) -> bool {
    if constexpr (std::is_same_v<A, Point> && std::is_same_v<B, Point>) {
      return a == b;
    } else if constexpr (std::is_same_v<A, Point>) {
      return b.has_on(a);
    } else if constexpr (std::is_same_v<B, Point>) {
      return a.has_on(b);
    } else {
      return CGAL::do_intersect(a, b);
    }
  };
  return std::visit(intersect, to_cgal<Kernel>(p), to_cgal<Kernel>(q));
}

}  // namespace boxtree::test
