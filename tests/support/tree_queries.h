// SPDX-License-Identifier: MIT
// Every query of a tree, for tests of properties that all queries share: no allocation, bounded
// stack, the caller's limits, errors for corrupt bytes.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <boxtree/boxtree.h>

namespace boxtree::test {

/// The arguments of the queries, in object space.
struct QuerySet {
  Ray ray{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};
  Eigen::AlignedBox3d box;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double radius = 1;             // of the sphere around `point`
  double thickness = 0.25;       // of the shapes that are cast along the ray
  Pose near = Pose::Identity();  // of the second tree, touching the first
  Pose far = Pose::Identity();   // of the second tree, apart from the first
  /// Limit of nodes expanded by the closest-point query with bounds.
  std::uint64_t node_budget = 1000;
};

/// The result of a query: its error, or a number computed from its answer.
struct Outcome {
  Errc error = Errc::kOk;
  double answer = 0;
};

struct TreeQuery {
  const char* name;
  std::size_t stack_kilobytes;  // the maximum that its documentation states
  bool is_of_pairs;             // uses both trees; others ignore the second
  bool takes_limits;            // others ignore the limits
  std::function<Outcome(const Tree& first, const Tree& second, const QueryLimits& limits)>
      run_query;
};

/// Every query in the public headers has a line here; the tests above then cover it.
[[nodiscard]] std::vector<TreeQuery> tree_queries(const QuerySet& queries);

}  // namespace boxtree::test
