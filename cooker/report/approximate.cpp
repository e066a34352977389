// SPDX-License-Identifier: MIT
// Runs every query with every setting; nodes and errors are from one run, times from several.
#include "cooker/report/approximate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <boxtree/boxtree.h>

namespace boxtree::cooker {
namespace {

struct Settings {
  std::vector<double> errors;
  std::vector<std::uint64_t> point_budgets;
  std::vector<std::uint64_t> distance_budgets;
};

Settings settings(bool quick) {
  if (quick) return {{0, 0.01, 0.1, 1}, {8, 32, 128, 512}, {16, 256, 4096, 65536}};
  return {{0, 1e-4, 1e-3, 0.01, 0.03, 0.1, 0.3, 1},
          {4, 8, 16, 32, 64, 128, 256, 512},
          {4, 16, 64, 256, 1024, 4096, 16384, 65536}};
}

// Bounds that both kinds of answers have.
struct Bounds {
  Errc error = Errc::kOk;
  double lower = 0;
  double upper = 0;
  bool is_found = false;
  bool converged = false;
  std::uint64_t nodes = 0;
};

template <class Answer>
Bounds bounds_of(const Result<Answer>& answer) {
  if (!answer) return {answer.code()};
  return {Errc::kOk,         answer->lower,         answer->upper, answer->witness.has_value(),
          answer->converged, answer->nodes_expanded};
}

Bounds run_query(const Tree& tree, const Eigen::Vector3d& point,
                 const Approximation& approximation) {
  return bounds_of(closest_point(tree, point, approximation));
}

Bounds run_query(const Tree& tree, const Pose& pose, const Approximation& approximation) {
  return bounds_of(distance(tree, Pose::Identity(), tree, pose, approximation));
}

template <class Query>
Result<std::vector<TrueDistance>> truths_of(const Tree& tree, const std::vector<Query>& queries) {
  std::vector<TrueDistance> truths;
  for (const Query& query : queries) {
    const Bounds bounds = run_query(tree, query, {});
    if (bounds.error != Errc::kOk) return bounds.error;
    truths.push_back({bounds.lower, bounds.upper});
  }
  return truths;
}

// Measures one kind of queries, one setting after another.
template <class Query>
class Sweep {
 public:
  Sweep(const Tree& tree, const std::vector<Query>& queries,
        const std::vector<TrueDistance>& truths, std::size_t runs)
      : tree_(tree), queries_(queries), truths_(truths), runs_(runs) {
    const double diagonal = bounds_in_object_space(tree).diagonal().norm();
    resolution_ = std::ldexp(diagonal, -44);
    least_distance_ = kLeastDistance * diagonal;
  }

  template <class Value>
  Result<std::vector<ApproximateStep>> over(const std::vector<Value>& values,
                                            Value Approximation::*allowed) {
    std::vector<ApproximateStep> steps;
    before_.clear();
    for (const Value value : values) {
      Approximation approximation;
      approximation.*allowed = value;
      const Result<ApproximateStep> step = measure(approximation);
      if (!step) return step.error();
      steps.push_back(*step);
    }
    return steps;
  }

 private:
  Result<ApproximateStep> measure(const Approximation& approximation) {
    ApproximateStep step;
    step.relative_error = approximation.relative_error;
    step.node_budget = approximation.node_budget;
    step.queries = queries_.size();
    std::vector<double> nodes;
    std::vector<double> errors;
    std::vector<double> gaps;
    for (std::size_t i = 0; i < queries_.size(); ++i) {
      const Bounds found = run_query(tree_, queries_[i], approximation);
      if (found.error != Errc::kOk) return found.error;
      const TrueDistance& truth = truths_[i];
      nodes.push_back(static_cast<double>(found.nodes));
      if (!before_.empty() && nodes[i] > before_[i]) ++step.slower;
      if (found.converged) ++step.converged;
      if (found.lower > truth.upper || found.upper < truth.lower) ++step.false_bounds;
      if (!found.is_found) continue;
      const double scale = std::max(truth.upper, least_distance_);
      const double error = found.upper - truth.upper;
      errors.push_back(error > resolution_ ? error / scale : 0);
      gaps.push_back((found.upper - found.lower) / scale);
    }
    step.found = errors.size();
    if (!errors.empty()) {
      step.error_max = *std::max_element(errors.begin(), errors.end());
      step.gap_max = *std::max_element(gaps.begin(), gaps.end());
      step.error_median = median(std::move(errors));
      step.gap_median = median(std::move(gaps));
    }
    if (!nodes.empty()) {
      step.nodes_mean =
          std::accumulate(nodes.begin(), nodes.end(), 0.0) / static_cast<double>(nodes.size());
      step.nodes_median = median(nodes);
    }
    before_ = std::move(nodes);
    if (runs_ == 0) return step;
    Status status;
    step.times = time_each(queries_, runs_, status, [&](const Query& query) {
      return run_query(tree_, query, approximation).error;
    });
    if (!status) return status.error();
    return step;
  }

  const Tree& tree_;
  const std::vector<Query>& queries_;
  const std::vector<TrueDistance>& truths_;
  const std::size_t runs_;
  double resolution_ = 0;
  double least_distance_ = 0;
  std::vector<double> before_;  // nodes of each query in the previous step
};

template <class Query>
Result<ApproximateCurves> curves_of(const Tree& tree, const std::vector<Query>& queries,
                                    const std::vector<TrueDistance>& truths, std::size_t runs,
                                    const std::vector<double>& errors,
                                    const std::vector<std::uint64_t>& budgets) {
  Sweep<Query> sweep(tree, queries, truths, runs);
  auto by_error = sweep.over(errors, &Approximation::relative_error);
  if (!by_error) return by_error.error();
  auto by_budget = sweep.over(budgets, &Approximation::node_budget);
  if (!by_budget) return by_budget.error();
  return ApproximateCurves{std::move(*by_error), std::move(*by_budget)};
}

}  // namespace

Result<TrueDistances> true_distances(const Tree& tree, const Workload& queries) {
  auto points = truths_of(tree, queries.points);
  if (!points) return points.error();
  auto poses = truths_of(tree, queries.apart);
  if (!poses) return poses.error();
  return TrueDistances{std::move(*points), std::move(*poses)};
}

Result<ApproximateFigures> measure_approximate(const Tree& tree, const Workload& queries,
                                               const TrueDistances& truth,
                                               const ApproximateEffort& effort) {
  const Settings set = settings(effort.quick);
  auto points =
      curves_of(tree, queries.points, truth.points, effort.runs, set.errors, set.point_budgets);
  if (!points) return points.error();
  auto poses =
      curves_of(tree, queries.apart, truth.poses, effort.runs, set.errors, set.distance_budgets);
  if (!poses) return poses.error();
  return ApproximateFigures{std::move(*points), std::move(*poses)};
}

}  // namespace boxtree::cooker
