// SPDX-License-Identifier: MIT
// Every query of a tree, each once, for tests of what holds for all of them: none allocates, each
// keeps to its stack and to its caller's limits, and each says what is corrupt.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <boxtree/boxtree.h>

namespace boxtree::test {

/// Where queries look, in object space.
struct QuerySet {
  Ray ray{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};
  Eigen::AlignedBox3d box;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double radius = 1;             // of the sphere around `point`
  Pose near = Pose::Identity();  // of the second tree, where it touches the first
  Pose far = Pose::Identity();   // where it does not
  /// Of the closest point with bounds: nodes expanded.
  std::uint64_t node_budget = 1000;
};

/// What came of a query: its error, or a number that stands for its answer.
struct Outcome {
  Errc error = Errc::kOk;
  double answer = 0;
};

struct TreeQuery {
  const char* name;
  std::size_t stack_kilobytes;  // at most, as its page states
  bool is_of_pairs;             // of two trees; others do not look at the second
  bool takes_limits;            // others do not look at the limits
  std::function<Outcome(const Tree& first, const Tree& second, const QueryLimits& limits)>
      run_query;
};

/// A query that is added to the public headers has a line here, and none in those tests.
[[nodiscard]] std::vector<TreeQuery> tree_queries(const QuerySet& queries);

}  // namespace boxtree::test
