// SPDX-License-Identifier: MIT
// The answers that all libraries are compared with: every triangle, no tree, exact predicates.
#pragma once

#include "tests/bench/subject.h"

namespace boxtree::bench {

/// Answers to the first queries of each kind of a workload, as many as brute force can compute in a
/// few seconds: over n triangles (n log n and the overlaps along one axis for pairs).
struct ExactAnswers {
  std::vector<double> rays;
  std::vector<double> camera;
  std::vector<double> segments;
  std::vector<double> sphere_casts;
  std::vector<double> spheres;  // numbers of triangles that touch
  std::vector<double> boxes;
  std::vector<double> points;
  std::vector<double> pairs;      // numbers of pairs; non-zero means contact
  std::vector<double> distances;  // in the poses apart
};

/// Shapes of 1 % of the diagonal that move along the rays of a workload.
[[nodiscard]] std::vector<ShapeCast> casts_of(const cooker::Workload& workload, ShapeKind kind);

/// As many such shapes, each around a random point of a random triangle, off it by half the radius
/// in the mean.
[[nodiscard]] std::vector<PlacedShape> shapes_on(const TriangleMesh& mesh,
                                                 const cooker::Workload& workload,
                                                 std::size_t count, ShapeKind kind);

/// `shapes`: the number of queries with each shape.
[[nodiscard]] ExactAnswers exact_answers(const TriangleMesh& mesh, const cooker::Workload& workload,
                                         std::size_t shapes);

}  // namespace boxtree::bench
