// SPDX-License-Identifier: MIT
// The answers that all libraries are compared with: every triangle, no tree, exact predicates.
#pragma once

#include "tests/bench/subject.h"

namespace boxtree::bench {

/// Answers to the first queries of each kind of a workload, as many as brute force can compute in a
/// few seconds: over n triangles (n log n and the overlaps along one axis for pairs).
struct ExactAnswers {
  std::vector<double> rays;
  std::vector<double> sphere_casts;
  std::vector<double> boxes;
  std::vector<double> points;
  std::vector<double> pairs;      // numbers of pairs; non-zero means contact
  std::vector<double> distances;  // in the poses apart
};

[[nodiscard]] std::vector<SphereCast> sphere_casts(const cooker::Workload& workload);

[[nodiscard]] ExactAnswers exact_answers(const TriangleMesh& mesh,
                                         const cooker::Workload& workload);

}  // namespace boxtree::bench
