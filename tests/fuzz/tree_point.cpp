// SPDX-License-Identifier: MIT
// Closest points on the tree of any file, exact and approximate, and those of batches.
#include <array>

#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {
namespace {

// The point among others that are near it.
void find_many(const Tree& tree, const Eigen::Vector3d& point, double max_distance,
               const QueryInput& query, const Check& check) {
  std::array<Eigen::Vector3d, 20> points;
  points.fill(point);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i][static_cast<Eigen::Index>(i % 3)] += static_cast<double>(i / 3) * query.number(6);
  }
  std::array<PointResult, 20> results;
  const auto first = std::span(points).first(1 + query.option(3) % points.size());
  const auto some = std::span(results).first(first.size());
  if (!closest_points(tree, first, some, max_distance, query.limits()).ok()) {
    finding("a batch with as many results as points was refused");
  }
  for (std::size_t i = 0; i < some.size(); ++i) {
    check(some[i]);
    const PointResult alone = closest_point(tree, points[i], max_distance, query.limits());
    check.holds(alone.code() == some[i].code() && alone.has_value() == some[i].has_value() &&
                    alone->distance == some[i]->distance &&
                    alone->face.index == some[i]->face.index &&
                    alone->triangle == some[i]->triangle,
                "a point of a batch is answered unlike the same point alone");
  }
}

}  // namespace

void run(Bytes input) {
  query_tree(input, [](const Tree& tree, const QueryInput& query, const auto& check) {
    const Eigen::Vector3d point = query.vector(0);
    if (query.option(1) % 2 == 0) {
      const double max_distance =
          query.option(1) % 4 == 2 ? query.number(3) : std::numeric_limits<double>::infinity();
      if (query.option(1) % 8 >= 4) find_many(tree, point, max_distance, query, check);
      check(closest_point(tree, point, max_distance, query.limits()));
      return;
    }
    PointOptions options;
    options.relative_error = query.number(3);
    options.absolute_error = query.number(4);
    if (query.option(1) % 4 == 3) options.max_distance = query.number(5);
    if (query.option(2) != 0) options.node_budget = query.option(2);
    const auto found = closest_point(tree, point, options);
    check(found);
    if (found && !(found->lower <= found->upper)) finding("bounds of a distance cross");
  });
}

}  // namespace boxtree::fuzz
