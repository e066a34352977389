// SPDX-License-Identifier: MIT
// What touches many boxes or spheres in one tree.
#pragma once

#include <cstddef>
#include <span>

#include <boxtree/overlap_batch.h>

#include "runtime/primitive/float_state.h"
#include "runtime/query/invalid_query.h"
#include "runtime/query/shape_query.h"
#include "runtime/query/visit_result.h"
#include "runtime/walk/packets.h"
#include "runtime/walk/walk_tree.h"

namespace boxtree {

/// The visitor of one shape of a batch.
struct ShapeVisitor {
  BatchFaceVisitor visitor;
  std::size_t number;

  [[nodiscard]] bool operator()(const FaceRef& face) const { return visitor(number, face); }
};

/// Every shape gets its result by one of these functions. `Given`: what the caller names a shape
/// by.
template <class Shape, class Given>
struct OverlapBatch {
  using QueryShape = Shape;
  using Visitor = ShapeVisitor;

  const BoundTree& tree;
  std::span<const Given> shapes;
  std::span<VisitResult> results;  // as many
  BatchFaceVisitor visitor;
  const QueryLimits& limits;

  [[nodiscard]] QueriedShape<Shape> in_tree(std::size_t i) const noexcept {
    return in_tree_space(tree, shapes[i]);
  }
  void refuse(std::size_t i, const char* invalid) { results[i] = {Errc::kInvalidQuery, invalid}; }
  /// How its visit ended.
  template <class Report>
  void answer(std::size_t i, const Report& report) {
    results[i] = visit_result(outcome_of(Errc::kOk, report));
  }
  /// By a walk of its own.
  void answer_alone(std::size_t i) {
    const QueriedShape<Shape> shape = in_tree(i);
    if (shape.invalid != nullptr) return refuse(i, shape.invalid);
    QueryWork work(limits);
    const ShapeVisitor faces{visitor, i};
    results[i] = visit_result(visit_faces(tree, shape.shape, faces, work));
  }
};

using BoxBatch = OverlapBatch<BoxQuery, Eigen::AlignedBox3d>;
using SphereBatch = OverlapBatch<SphereQuery, Sphere>;

/// By vectors; see walk_tree.h. Precondition: the tree has wide and float nodes.
void walk_wide(BoxBatch& batch);
void walk_wide(SphereBatch& batch);

template <class Batch, class Given>
[[nodiscard]] Status visit_batch(const Tree& tree, std::span<const Given> shapes,
                                 std::span<VisitResult> results, BatchFaceVisitor visitor,
                                 const QueryLimits& limits) {
  if (results.size() != shapes.size()) return invalid_query("results.size()");
  const DefaultFloatState state;
  Batch batch{BoundTree::of(tree), shapes, results, visitor, limits};
  answer_batch(batch, limits);
  return {};
}

}  // namespace boxtree
