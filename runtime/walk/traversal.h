// SPDX-License-Identifier: MIT
// The two ways to walk one tree. Every single-tree query is one of them with its own box test.
//
// Why a traversal gives exactly the answers of brute force: a query's box test is monotone (a test
// that a box passes is passed by every box around it, in floating point as in theory), every box
// contains the boxes and triangles below it, and each leaf predicate first puts the triangle's own
// bounds through the same box test. So a triangle that the predicate accepts passes at every node
// above it, whatever the rounding.
//
// Why it ends on any bytes: WalkBound.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include <boxtree/query.h>

#include "format/limits.h"
#include "runtime/tree/bound_tree.h"
#include "runtime/tree/root_box.h"
#include "runtime/walk/face_copies.h"
#include "runtime/walk/work.h"

namespace boxtree {

/// The bounds of a triangle, in the form of a box.
[[nodiscard]] inline Box<double> bounds_of(const Triangle& triangle) noexcept {
  Box<double> box;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    const double a = triangle.corner[0][axis];
    const double b = triangle.corner[1][axis];
    const double c = triangle.corner[2][axis];
    // Not of lists, for which -O2 calls a function with a loop.
    box.low[k] = std::min(std::min(a, b), c);
    box.high[k] = std::max(std::max(a, b), c);
  }
  return box;
}

/// 1 for the second triangle of a quad, else 0.
[[nodiscard]] inline std::uint32_t half_of_face(const TriangleBatch& batch,
                                                std::uint32_t triangle) noexcept {
  return triangle > 0 && batch.face[triangle - 1] == batch.face[triangle] ? 1 : 0;
}

/// Squared distance from a point to a closed box; monotone in the box, zero inside.
template <class S>
[[nodiscard]] double squared_distance(const Eigen::Vector3d& point, const Box<S>& box) noexcept {
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double p = point[static_cast<Eigen::Index>(k)];
    const double outside = std::max(std::max(0.0, box.low[k] - p), p - box.high[k]);
    sum += outside * outside;
  }
  return sum;
}

/// Entries that a depth-first walk of one tree can have pending: all but one child of each node on
/// a path, and the root.
template <NodeDecoder C>
inline constexpr std::size_t kStackSize = C::kDepthLimit*(C::Children::kWidth - 1) + 1;

/// How a walk for a visitor ended: `query` holds the error of a leaf, and whether its visitor
/// stopped the walk.
template <class Query>
[[nodiscard]] Result<Visit> outcome_of(Errc walked, const Query& query) {
  if (walked != Errc::kOk) return walked;
  if (query.error != Errc::kOk) return query.error;
  return query.stopped ? Visit::kStopped : Visit::kComplete;
}

/// Visits every leaf whose box passes, in no promised order. `tree`: a BoundTree or a type like it.
/// query.overlaps(const Box<S>&) -> bool: the monotone box test.
/// query.leaf(NodeRef) -> bool: whether to go on; the query keeps its own state and error.
/// query.nodes: a WalkBound, of as many nodes as the tree's record states.
/// Returns kNodeCorrupt or kDepthExceeded for corrupt nodes, kWorkLimit, else kOk.
template <class Source, NodeDecoder C, class Query>
Errc traverse_overlap(const Source& tree, const C codec, Query& query) {
  using S = typename C::Scalar;
  struct Entry {
    Box<S> box;
    NodeRef ref;
  };
  if (tree.empty()) return Errc::kOk;
  const Box<S> root = root_box<S>(tree);
  if (!query.overlaps(root)) return Errc::kOk;
  if (tree.is_leaf()) {
    static_cast<void>(query.leaf(tree.root_ref()));
    return Errc::kOk;
  }
  WalkStack<Entry, kStackSize<C>> stack;
  Errc error = stack.push({root, tree.root_ref()});
  typename C::Children children;
  while (error == Errc::kOk && !stack.empty()) {
    const Entry entry = stack.pop();
    error = query.nodes.count(codec.expand(entry.ref, entry.box, children));
    if (error != Errc::kOk) return error;
    for (std::uint32_t i = 0; i < children.count; ++i) {
      const Box<S> box = children.box(i);
      if (!query.overlaps(box)) continue;
      if (children.is_leaf(i)) {
        if (!query.leaf(children.ref[i])) return Errc::kOk;
        continue;
      }
      error = stack.push({box, children.ref[i]});
      if (error != Errc::kOk) return error;
    }
  }
  return error;
}

/// Visits leaves roughly from near to far, and none whose key is above the query's bound.
/// query.key(const Box<S>&) -> double: a lower bound of what any triangle inside can give, infinity
///   for a box that fails; monotone: never smaller for a box inside.
/// query.bound() -> double: keys above it cannot improve the answer. Equal keys are still visited,
///   so that ties are decided by the query and not by the order of the walk.
/// query.leaf(NodeRef) -> bool: whether to go on.
/// query.nodes_expanded, if it has one, counts the nodes expanded. query.nodes: as above.
template <class Source, NodeDecoder C, class Query>
Errc traverse_nearest(const Source& tree, const C codec, Query& query) {
  using S = typename C::Scalar;
  constexpr std::size_t kWidth = C::Children::kWidth;
  struct Entry {
    double key;
    Box<S> box;
    NodeRef ref;
  };
  if (tree.empty()) return Errc::kOk;
  const Box<S> root = root_box<S>(tree);
  const double root_key = query.key(root);
  if (!(root_key <= query.bound())) return Errc::kOk;
  if (tree.is_leaf()) {
    static_cast<void>(query.leaf(tree.root_ref()));
    return Errc::kOk;
  }
  WalkStack<Entry, kStackSize<C>> stack;
  Errc error = stack.push({root_key, root, tree.root_ref()});
  typename C::Children children;
  while (error == Errc::kOk && !stack.empty()) {
    const Entry entry = stack.pop();
    if (entry.key > query.bound()) continue;
    if constexpr (requires { query.nodes_expanded; }) ++query.nodes_expanded;
    error = query.nodes.count(codec.expand(entry.ref, entry.box, children));
    if (error != Errc::kOk) return error;

    std::array<double, kWidth> key;
    std::array<std::uint32_t, kWidth> order;  // children that pass, nearest first
    std::size_t passed = 0;
    for (std::uint32_t i = 0; i < children.count; ++i) {
      const double k = query.key(children.box(i));
      if (!(k <= query.bound()) || k == std::numeric_limits<double>::infinity()) continue;
      std::size_t place = passed++;
      for (; place > 0 && key[place - 1] > k; --place) {
        key[place] = key[place - 1];
        order[place] = order[place - 1];
      }
      key[place] = k;
      order[place] = i;
    }
    for (std::size_t n = 0; n < passed; ++n) {
      if (!children.is_leaf(order[n]) || key[n] > query.bound()) continue;
      if (!query.leaf(children.ref[order[n]])) return Errc::kOk;
    }
    for (std::size_t n = passed; n-- > 0;) {  // farthest first, so that the nearest is on top
      if (children.is_leaf(order[n])) continue;
      error = stack.push({key[n], children.box(order[n]), children.ref[order[n]]});
      if (error != Errc::kOk) return error;
    }
  }
  return error;
}

}  // namespace boxtree
