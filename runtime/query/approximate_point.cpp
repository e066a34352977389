// SPDX-License-Identifier: MIT
// Closest points within an error or a number of nodes, over any codec.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <boxtree/closest.h>

#include "runtime/primitive/float_state.h"
#include "runtime/primitive/rounding.h"
#include "runtime/primitive/vector3.h"
#include "runtime/query/approximation.h"
#include "runtime/query/best_first.h"
#include "runtime/query/invalid_query.h"
#include "runtime/query/point_query.h"
#include "runtime/query/scaled_length.h"
#include "runtime/walk/walk_tree.h"

namespace boxtree {
namespace {

// An upper bound of the length of a vector, even where its square underflows.
double length_above(const Eigen::Vector3d& v) noexcept {
  constexpr double kMore = 1 + 4 * kRoundoffF64;
  constexpr int kExponent = 600;
  const double square = squared_length(v);
  if (square > 0x1p-900) return std::sqrt(square) * kMore;
  return scaled_above(std::sqrt(squared_length(std::ldexp(1.0, kExponent) * v)) * kMore,
                      -kExponent);
}

}  // namespace

Result<ApproximatePoint> closest_point(const Tree& queried, const Eigen::Vector3d& point,
                                       const PointOptions& options) {
  const DefaultFloatState state;
  const BoundTree& tree = BoundTree::of(queried);
  const Frame& frame = tree.frame();
  const Eigen::Vector3d tree_point = frame.to_tree(point);
  if (!is_within_range(tree_point)) return invalid_query("point");
  if (const char* field = invalid_field(options)) return invalid_query(field);
  ApproximatePoint result;
  result.lower = std::numeric_limits<double>::infinity();
  if (tree.empty()) return result;

  Approximation approximation = options;
  approximation.absolute_error *= frame.inverse_scale;
  approximation.max_distance *= frame.inverse_scale;
  WalkBound nodes(tree.node_count());
  const double most = largest_square_within(approximation.max_distance);
  PointQuery query(tree, nodes, tree_point, most);
  query.approximation = &approximation;
  double left = std::numeric_limits<double>::infinity();  // squared: of what was not visited
  Errc walked;
  if (options.node_budget == kUnlimitedNodes) {
    walked = walk_nearest(tree, query);
  } else {
    SearchBudget budget{options.node_budget};
    walked = search_within(tree, query, budget);
    left = budget.left;
    result.converged = !budget.is_spent;
  }
  if (walked != Errc::kOk) return walked;
  if (query.error != Errc::kOk) return query.error;

  // What was skipped is beyond the bound, or was not visited; keys are within a factor of 1 + 4 u
  // of the square that they stand for, and so is a root. The point itself is off by the rounding of
  // its conversion to tree space.
  const int exponent = tree.scale_exponent();
  const double place =
      frame.origin.isZero(0) ? 0 : 2 * kRoundoffF64 * tree_point.cwiseAbs().maxCoeff();
  const double untested = std::sqrt(std::min(query.best, left)) * (1 - 8 * kRoundoffF64);
  result.lower =
      scaled_below(std::max(0.0, std::min(untested, query.tested_lower) - place), exponent);
  result.nodes_expanded = query.nodes_expanded;
  if (!query.found) return result;
  query.name_face();
  // A point of a face is off by up to 26 u of the largest coordinate (see triangle_distance.cpp),
  // and the point itself by half the least double where its conversion to tree space underflows.
  const double off = 26 * kRoundoffF64 * tree.largest_abs() + place;
  const double lost =
      frame.to_object(tree_point) == point ? 0 : std::numeric_limits<double>::denorm_min();
  const double upper = length_above(query.found->point - tree_point) + off + lost;
  result.upper = scaled_above(upper, exponent);
  result.witness = query.found;
  result.witness->point = frame.to_object(query.found->point);
  result.witness->distance = std::sqrt(query.found->distance) * frame.scale;
  return result;
}

}  // namespace boxtree
