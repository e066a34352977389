// SPDX-License-Identifier: MIT
// Queries of every kind to one tree, and the answers as bits, so that "the same" means the same.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "tests/robustness/subjects.h"

namespace boxtree::robustness {

struct Sphere {
  Eigen::Vector3d center;
  double radius;
};

/// In object space. Pairs are the tree against itself, the second one in that pose.
struct QuerySet {
  std::vector<Ray> rays;
  std::vector<Eigen::AlignedBox3d> boxes;
  std::vector<Sphere> spheres;
  std::vector<Eigen::Vector3d> points;
  std::vector<Pose> poses;
};

/// How many of each kind.
struct QueryCounts {
  std::size_t rays = 200;
  std::size_t boxes = 60;
  std::size_t spheres = 60;
  std::size_t points = 60;
  std::size_t poses = 6;
};

/// Seeded queries about a mesh; a part of each kind is degenerate on purpose: along axes, through
/// vertices, of no size, in the planes of vertices.
[[nodiscard]] QuerySet queries_for(const SourceMesh& mesh, std::uint64_t seed,
                                   const QueryCounts& counts = {});

/// Every coordinate and length times 2^exponent; directions too, so that parameters stay.
[[nodiscard]] QuerySet scaled(const QuerySet& queries, int exponent);

/// The answers to one query after the other, in the order of Queries: error code, face ids
/// (sorted where the order is not promised) and the bits of all numbers.
using Answers = std::vector<std::vector<std::uint64_t>>;

/// `exponent`: lengths are divided by 2^exponent before their bits are taken.
[[nodiscard]] Answers run_query(const Tree& tree, const QuerySet& queries, int exponent = 0);

/// How many answers differ; all when the numbers of queries do.
[[nodiscard]] std::size_t count_differing(const Answers& a, const Answers& b);

/// How many answers name a face.
[[nodiscard]] std::size_t count_hits(const Answers& answers);

}  // namespace boxtree::robustness
