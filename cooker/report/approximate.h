// SPDX-License-Identifier: MIT
// What an allowed error or a budget of nodes saves, and how far answers then are from the truth.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cooker/choose/measure.h"
#include "cooker/choose/workload.h"
#include "runtime/query/approximation.h"

namespace boxtree::cooker {

/// One setting, over all queries. Errors are shares of the true distance. Bounds resolve some
/// 2^-44 of the mesh's diagonal: errors below that count as none, distances below it as that.
struct ApproximateStep {
  double relative_error = 0;                    // allowed
  std::uint64_t node_budget = kUnlimitedNodes;  // allowed
  KindTimes times;                              // zero unless timed
  double nodes_mean = 0;                        // nodes expanded and leaves read
  double nodes_median = 0;
  double error_median = 0;  // of what was found: how much farther it is than the nearest
  double error_max = 0;
  double gap_median = 0;         // what the answers themselves state: upper - lower
  double gap_max = 0;            // likewise
  std::size_t queries = 0;       // all of them
  std::size_t found = 0;         // those with a witness: medians and maxima are over these
  std::size_t converged = 0;     // those that say so: the budget did not run out
  std::size_t false_bounds = 0;  // those whose bounds do not hold the truth: 0, or a defect
  std::size_t slower = 0;        // those that took more nodes than in the step before
};

enum class ApproximateKind : std::uint8_t { kPoint, kDistance };
inline constexpr std::size_t kApproximateKinds = 2;
inline constexpr std::array<const char*, kApproximateKinds> kApproximateNames = {"point",
                                                                                 "distance"};

/// Steps in order: errors growing without a budget, then budgets growing without an error.
struct ApproximateCurves {
  std::vector<ApproximateStep> by_error;
  std::vector<ApproximateStep> by_budget;
};
using ApproximateFigures = std::array<ApproximateCurves, kApproximateKinds>;

/// Bounds of a true distance.
struct TrueDistance {
  double lower = 0;
  double upper = 0;
};

/// Of the closest points and of the poses apart.
struct TrueDistances {
  std::vector<TrueDistance> points;
  std::vector<TrueDistance> poses;
};

/// Queries with no error allowed. Errors: those of the queries.
Result<TrueDistances> true_distances(const Tree& tree, const Workload& queries);

struct ApproximateEffort {
  bool quick = false;    // half of the steps
  std::size_t runs = 5;  // 0: nodes are counted, nothing is timed
};

/// Closest points, and distances of the tree and its copy in the poses apart, for each allowed
/// error and each budget. `truth` may come from any tree of the same geometry.
Result<ApproximateFigures> measure_approximate(const Tree& tree, const Workload& queries,
                                               const TrueDistances& truth,
                                               const ApproximateEffort& effort);

}  // namespace boxtree::cooker
