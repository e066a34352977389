// SPDX-License-Identifier: MIT
// A shape among others near it in one batch, against each alone.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {

/// What a visit found, in order.
struct Visited {
  std::uint64_t faces = 0;
  std::uint64_t digest = 0;

  /// Stops after `most` faces.
  bool add(const FaceRef& face, std::uint64_t most) {
    digest = digest * 0x9e3779b97f4a7c15u + face.index;
    return ++faces < most;
  }
};

/// `shape_at(offset)`: the shape moved so far. `all(shapes, results, visitor, limits)` and
/// `one(shape, visitor, limits)`: the query.
template <class ShapeAt, class All, class One>
void visit_many(const QueryInput& query, const Check& check, const ShapeAt& shape_at,
                const All& all, const One& one) {
  std::array<decltype(shape_at(Eigen::Vector3d())), 20> shapes;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const double way = static_cast<double>(i / 3) * query.number(6);
    shapes[i] = shape_at(way * Eigen::Vector3d::Unit(static_cast<Eigen::Index>(i % 3)));
  }
  const std::uint64_t most = query.option(2) == 0 ? ~std::uint64_t{0} : query.option(2);
  std::array<Visited, 20> visited;
  std::array<VisitResult, 20> results;
  const auto first = std::span(shapes).first(1 + query.option(3) % shapes.size());
  const auto some = std::span(results).first(first.size());
  const auto visitor = [&](std::size_t i, const FaceRef& face) {
    return visited[i].add(face, most);
  };
  if (!all(first, some, visitor, query.limits()).ok()) {
    finding("a batch with as many results as shapes was refused");
  }
  for (std::size_t i = 0; i < some.size(); ++i) {
    check(some[i]);
    Visited faces;
    const Result<Visit> alone = one(
        first[i], [&](const FaceRef& face) { return faces.add(face, most); }, query.limits());
    check.holds(alone.code() == some[i].code() && (!alone || *alone == *some[i]) &&
                    faces.faces == visited[i].faces && faces.digest == visited[i].digest,
                "a shape of a batch is answered unlike the same shape alone");
  }
}

}  // namespace boxtree::fuzz
