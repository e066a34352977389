// SPDX-License-Identifier: MIT
// Adds up the expected visits of a tree during encoding.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "cooker/encode/encoded.h"

namespace boxtree::cooker {

/// See ExpectedVisits. The probability that a query reaches a box is a ratio of measures of two
/// convex bodies: areas for lines, volumes of Minkowski sums for boxes (integral geometry, as in
/// the SAH).
class VisitCost {
 public:
  VisitCost() = default;
  template <class S>
  explicit VisitCost(const Box<S>& root) {
    double squared = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double extent = double{root.high[k]} - double{root.low[k]};
      squared += extent * extent;
      half_[k] = extent / 2;
    }
    edge_ = 0.05 * std::sqrt(squared);
    root_ = measure(root);
  }

  template <class S>
  void add(const Box<S>& box) {
    const ExpectedVisits here = measure(box);
    // A root that is a point or a line has no area: every query that reaches it visits all nodes.
    sum_.ray += root_.ray > 0 ? here.ray / root_.ray : 1;
    sum_.box += root_.box > 0 ? here.box / root_.box : 1;
    sum_.pair += root_.pair > 0 ? here.pair / root_.pair : 1;
  }

  [[nodiscard]] ExpectedVisits visits() const { return sum_; }

 private:
  template <class S>
  [[nodiscard]] ExpectedVisits measure(const Box<S>& box) const {
    std::array<double, 3> e;
    for (std::size_t k = 0; k < 3; ++k) e[k] = double{box.high[k]} - double{box.low[k]};
    return {e[0] * e[1] + e[1] * e[2] + e[2] * e[0],
            (e[0] + edge_) * (e[1] + edge_) * (e[2] + edge_),
            (e[0] + half_[0]) * (e[1] + half_[1]) * (e[2] + half_[2])};
  }

  std::array<double, 3> half_{};
  double edge_ = 0;
  ExpectedVisits root_;
  ExpectedVisits sum_;
};

}  // namespace boxtree::cooker
