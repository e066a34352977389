// SPDX-License-Identifier: MIT
// The exact distance of two convex hulls, by CGAL's solver of quadratic programs over numbers
// without rounding: of a triangle from a point, segment, box or hull, and from all that one of them
// sweeps.
#pragma once

#include <CGAL/Gmpzf.h>
#include <CGAL/QP_functions.h>
#include <CGAL/QP_models.h>
#include <array>
#include <span>
#include <stdexcept>
#include <vector>

#include <Eigen/Core>

namespace boxtree::oracle {

using ExactNumber = CGAL::Gmpzf;
using ExactVector = std::array<ExactNumber, 3>;
using ExactSquare = CGAL::Quotient<ExactNumber>;

[[nodiscard]] inline ExactVector exact(const Eigen::Vector3d& v) {
  return {ExactNumber(v[0]), ExactNumber(v[1]), ExactNumber(v[2])};
}
[[nodiscard]] inline ExactVector operator+(const ExactVector& a, const ExactVector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
[[nodiscard]] inline ExactVector operator-(const ExactVector& a, const ExactVector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
[[nodiscard]] inline ExactVector operator*(const ExactNumber& s, const ExactVector& v) {
  return {s * v[0], s * v[1], s * v[2]};
}
[[nodiscard]] inline ExactNumber dot(const ExactVector& a, const ExactVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The squared distance of the hull of `a` from that of `b`, neither of them empty: the least
/// square of a difference of two points of them, each a sum of corners with weights that add up
/// to 1.
[[nodiscard]] inline ExactSquare squared_distance(std::span<const ExactVector> a,
                                                  std::span<const ExactVector> b) {
  std::vector<ExactVector> columns;
  for (const ExactVector& p : a) columns.push_back(p - b[0]);
  for (const ExactVector& p : b) columns.push_back(b[0] - p);
  using Program = CGAL::Quadratic_program<ExactNumber>;
  Program program(CGAL::EQUAL);  // variables are 0 or more
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto row = static_cast<int>(i);
    program.set_a(row, i < a.size() ? 0 : 1, ExactNumber(1));
    // The solver takes twice the matrix, of which it reads one half.
    for (std::size_t j = 0; j <= i; ++j) {
      program.set_d(row, static_cast<int>(j), ExactNumber(2) * dot(columns[i], columns[j]));
    }
  }
  program.set_b(0, ExactNumber(1));
  program.set_b(1, ExactNumber(1));
  CGAL::Quadratic_program_options options;
  options.set_pricing_strategy(CGAL::QP_BLAND);  // ends, however degenerate
  const auto solution = CGAL::solve_quadratic_program(program, ExactNumber(), options);
  if (!solution.is_optimal()) throw std::logic_error("no least distance");
  return solution.objective_value();
}

}  // namespace boxtree::oracle
