// SPDX-License-Identifier: MIT
// The search for a closest point that may be stopped after any node.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include <boxtree/query.h>

#include "runtime/query/point_query.h"
#include "runtime/walk/erased_codec.h"

namespace boxtree {

/// How many nodes and leaves a search may visit, and what it left when it ended.
struct SearchBudget {
  std::uint64_t nodes;
  double left = std::numeric_limits<double>::infinity();  // the least key of what was not visited
  bool is_spent = false;
};

/// Children and their keys, PointQuery::key() of their boxes: the same numbers however they are
/// computed, so that a budget is spent at the same node on every machine.
struct NearChildren : ErasedCodec::Children {
  std::array<double, ErasedCodec::Children::kWidth> key;
};

/// How a search reads its tree. Borrows what it calls.
struct NearNodes {
  /// Counts and decodes a node. Anything but kOk ends the search.
  FunctionRef<Errc(NodeRef node, const Box<double>& box, NearChildren& out)> expand;
  /// Tests the faces of a leaf: whether to go on. If not, the query holds the error.
  FunctionRef<bool(NodeRef leaf)> read;
};

/// Visits nodes in the order of their keys until the budget is spent. Like the distance walk it is
/// depth-first at the start, so that a small budget finds something.
Errc search_best_first(const BoundTree& tree, PointQuery& query, SearchBudget& budget,
                       const NearNodes& nodes) noexcept;

/// The same for a tree of any codec, one box and one triangle at a time.
Errc search_best_first(const BoundTree& tree, PointQuery& query, SearchBudget& budget) noexcept;

/// By vectors; see walk_tree.h.
Errc walk_wide(const BoundTree& tree, PointQuery& query, SearchBudget& budget);

/// By vectors where the tree's nodes can be; the same to the bit.
Errc search_within(const BoundTree& tree, PointQuery& query, SearchBudget& budget) noexcept;

}  // namespace boxtree
