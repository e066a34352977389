// SPDX-License-Identifier: MIT
// Measures the savings and the true errors of queries with an allowed error or a budget of nodes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cooker/choose/measure.h"
#include "cooker/choose/workload.h"
#include "runtime/query/approximation.h"

namespace boxtree::cooker {

/// Errors are shares of the true distance, but no shares of less than this share of the mesh's
/// diagonal: where that is (nearly) 0, any error would be many times as much.
inline constexpr double kLeastDistance = 1e-3;

/// One setting, over all queries. Errors are shares as above. Bounds resolve about 2^-44 of the
/// mesh's diagonal: smaller errors count as zero.
struct ApproximateStep {
  double relative_error = 0;                    // allowed
  std::uint64_t node_budget = kUnlimitedNodes;  // allowed
  KindTimes times;                              // zero unless timed
  double nodes_mean = 0;                        // nodes expanded and leaves read
  double nodes_median = 0;
  double error_median = 0;  // of answers: excess over the true distance, share
  double error_max = 0;
  double gap_median = 0;         // upper - lower as stated by the answers
  double gap_max = 0;            // the same
  std::size_t queries = 0;       // all of them
  std::size_t found = 0;         // those with a witness; medians and maxima are over these
  std::size_t converged = 0;     // those that converged: the budget sufficed
  std::size_t false_bounds = 0;  // bounds that exclude the true distance; must be 0
  std::size_t slower = 0;        // those that took more nodes than in the previous step
};

enum class ApproximateKind : std::uint8_t { kPoint, kDistance };
inline constexpr std::size_t kApproximateKinds = 2;
inline constexpr std::array<const char*, kApproximateKinds> kApproximateNames = {"point",
                                                                                 "distance"};

/// Steps in order: increasing errors without a budget, then increasing budgets without an error.
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

/// For the closest points and for the poses apart.
struct TrueDistances {
  std::vector<TrueDistance> points;
  std::vector<TrueDistance> poses;
};

/// Results of queries with no error allowed. Errors: those of the queries.
Result<TrueDistances> true_distances(const Tree& tree, const Workload& queries);

struct ApproximateEffort {
  bool quick = false;    // half of the steps
  std::size_t runs = 5;  // 0: nodes are counted, nothing is timed
};

/// Closest points, and distances of the tree and its copy in the poses apart, for each allowed
/// error and each budget. `truth` may come from any tree with the same geometry.
Result<ApproximateFigures> measure_approximate(const Tree& tree, const Workload& queries,
                                               const TrueDistances& truth,
                                               const ApproximateEffort& effort);

}  // namespace boxtree::cooker
