// SPDX-License-Identifier: MIT
// Uses doubles where their error bound decides the sign, otherwise expansions.
#include "cooker/import/polygon_normal.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "runtime/primitive/expansion.h"

namespace boxtree::cooker {
namespace {

using Eigen::Vector3d;

// An exact sum of doubles: terms that do not overlap, smallest first (Shewchuk's grow-expansion;
// the number of terms is at most the span of all numbers in bits, divided by 53).
class ExactSum {
 public:
  void add(double value) {
    std::size_t kept = 0;
    for (const double term : terms_) {
      const Rounded sum = two_sum(value, term);
      if (sum.error != 0) terms_[kept++] = sum.error;
      value = sum.value;
    }
    terms_.resize(kept);
    if (value != 0) terms_.push_back(value);
  }
  void add_product(double a, double b) {
    const Rounded product = two_product(a, b);
    add(product.error);
    add(product.value);
  }
  [[nodiscard]] double estimate() const {
    double sum = 0;
    for (const double term : terms_) sum += term;
    return sum;
  }

 private:
  std::vector<double> terms_;
};

// Calls take(u, next_v, v, next_u) for each edge from (u, v), as seen along `axis`: twice the area
// is the sum of u next_v - v next_u.
template <class Take>
void for_each_edge(std::span<const Vector3d> corners, int axis, const Take& take) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const Vector3d* before = &corners.back();
  for (const Vector3d& corner : corners) {
    take((*before)[u], corner[v], (*before)[v], corner[u]);
    before = &corner;
  }
}

}  // namespace

int dominant_axis(const Vector3d& normal) {
  int axis = 2;
  for (int other = 0; other < 2; ++other) {
    if (std::abs(normal[other]) > std::abs(normal[axis])) axis = other;
  }
  return axis;
}

// Relative to the first corner. A product of two differences has three roundings and its sum with
// the others at most 2n + 1, each of at most half an epsilon; the sum of magnitudes has as many. 2
// (n + 4) epsilons include the second order, too, below 2^50 corners. Each product may lose 2^-1075
// to underflow. An axis is as good as the largest if the polygon has half as much area along it.
Vector3d polygon_normal(std::span<const Vector3d> corners) {
  const double count = static_cast<double>(corners.size());
  const double roundings = 2 * (count + 4) * std::numeric_limits<double>::epsilon();
  Vector3d normal, error;
  for (int axis = 0; axis < 3; ++axis) {
    const double from_u = corners[0][(axis + 1) % 3], from_v = corners[0][(axis + 2) % 3];
    double sum = 0, magnitude = 0;
    for_each_edge(corners, axis, [&](double u, double next_v, double v, double next_u) {
      const double left = (u - from_u) * (next_v - from_v);
      const double right = (v - from_v) * (next_u - from_u);
      sum += left - right;
      magnitude += std::abs(left) + std::abs(right);
    });
    normal[axis] = sum;
    error[axis] = roundings * magnitude + count * std::numeric_limits<double>::min();
  }
  const int largest = dominant_axis(normal);
  const double least = std::abs(normal[largest]) - error[largest];
  bool is_settled = least > 0;
  for (int axis = 0; axis < 3; ++axis) {
    is_settled =
        is_settled && (axis == largest || std::abs(normal[axis]) + error[axis] < 2 * least);
  }
  if (is_settled) return normal;
  for (int axis = 0; axis < 3; ++axis) {
    ExactSum exact;
    for_each_edge(corners, axis, [&](double u, double next_v, double v, double next_u) {
      exact.add_product(u, next_v);
      exact.add_product(-v, next_u);
    });
    normal[axis] = exact.estimate();
  }
  return normal;
}

}  // namespace boxtree::cooker
