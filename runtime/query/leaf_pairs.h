// SPDX-License-Identifier: MIT
// Compares the triangles of two leaves: what pair walks of all codecs share, compiled once.
#pragma once

#include <cstdint>

#include <boxtree/query.h>

#include "format/box.h"
#include "format/children.h"
#include "runtime/query/leaf_reading.h"
#include "runtime/query/pair_work.h"
#include "runtime/query/relative_pose.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree {

/// A leaf of each tree, with their boxes: each in its own tree space.
struct LeafPair {
  Box<double> first_box;
  Box<double> second_box;
  NodeRef first;
  NodeRef second;
};

/// Called with each triangle of the first leaf and of the second, moved into the first one's space,
/// that do not touch. Returns whether to end the walk.
using TriangleWatch = FunctionRef<bool(const Triangle& first, const Triangle& moved)>;

/// Reports the faces of two leaves that touch. Everything passed by reference must outlive it.
class LeafPairTest {
 public:
  LeafPairTest(const BoundTree& first, const BoundTree& second, const RelativePose& pose,
               PairVisitor visitor) noexcept
      : pose_(pose), report_(first, second, visitor), leaves_(first, second, pose) {}

  /// Each pair of faces once. `watch` may be null. Errors: those of corrupt leaves and copies.
  [[nodiscard]] Errc run(const LeafPair& leaves, const TriangleWatch* watch);

  /// Whether the visitor or the watch stopped it.
  [[nodiscard]] bool stopped() const noexcept { return stopped_ || report_.stopped(); }

 private:
  [[nodiscard]] bool was_found(std::uint64_t found, std::uint32_t j) const noexcept;

  const RelativePose& pose_;
  PairReport report_;
  bool stopped_ = false;  // by the watch
  LeafReading leaves_;
};

}  // namespace boxtree
