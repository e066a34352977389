// SPDX-License-Identifier: MIT
// Queries of every kind on one tree, and their answers as bits for exact comparison.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "tests/robustness/moving_shapes.h"
#include "tests/robustness/subjects.h"

namespace boxtree::robustness {

/// In object space. For pairs, the tree against itself; the second one has that pose.
struct QuerySet {
  std::vector<Ray> rays;
  std::vector<Eigen::AlignedBox3d> boxes;
  std::vector<Sphere> spheres;
  std::vector<Eigen::Vector3d> points;
  std::vector<Pose> poses;
  std::vector<Cast> casts;  // what they touch where they start is a query of its own
};

/// Number of queries of each kind.
struct QueryCounts {
  std::size_t rays = 200;
  std::size_t boxes = 60;
  std::size_t spheres = 60;
  std::size_t points = 60;
  std::size_t poses = 6;
  std::size_t casts = 5;  // brute force takes its time
};

/// Seeded queries on a mesh. A part of each kind is degenerate: along axes, through vertices, of
/// zero size, in the planes of vertices.
[[nodiscard]] QuerySet queries_for(const SourceMesh& mesh, std::uint64_t seed,
                                   const QueryCounts& counts = {});

/// Scales every coordinate and length by 2^exponent, directions too, so that parameters do not
/// change.
[[nodiscard]] QuerySet scaled(const QuerySet& queries, int exponent);

/// The answers to all queries, in the order of Queries: error code, face ids (sorted if the order
/// is not guaranteed) and the bits of all numbers.
using Answers = std::vector<std::vector<std::uint64_t>>;

/// `exponent`: lengths are divided by 2^exponent before their bits are taken.
[[nodiscard]] Answers run_query(const Tree& tree, const QuerySet& queries, int exponent = 0);

/// The number of answers that differ; all if the numbers of queries differ.
[[nodiscard]] std::size_t count_differing(const Answers& a, const Answers& b);

/// The number of answers with a face.
[[nodiscard]] std::size_t count_hits(const Answers& answers);

}  // namespace boxtree::robustness
