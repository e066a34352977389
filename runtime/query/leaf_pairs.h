// SPDX-License-Identifier: MIT
// The triangles of two leaves: what pair walks of all codecs do alike, compiled once.
#pragma once

#include <array>
#include <cstdint>

#include <boxtree/format/box.h>
#include <boxtree/format/children.h>
#include <boxtree/format/limits.h>
#include <boxtree/runtime/primitive/triangle.h>
#include <boxtree/runtime/query/relative_pose.h>
#include <boxtree/runtime/query/types.h>

namespace boxtree {

/// A leaf of each tree, with their boxes: each in its own tree space.
struct LeafPair {
  Box<double> first_box;
  Box<double> second_box;
  NodeRef first;
  NodeRef second;
};

/// Asked about each triangle of the first leaf and of the second, brought into the first one's
/// space, that do not touch: whether the walk is to end.
using TriangleWatch = FunctionRef<bool(const Triangle& first, const Triangle& moved)>;

/// Reports the faces of two leaves that touch. Everything passed by reference must outlive it.
class LeafPairTest {
 public:
  LeafPairTest(const Tree& first, const Tree& second, const RelativePose& pose,
               PairVisitor visitor) noexcept
      : first_(first), second_(second), pose_(pose), visitor_(visitor) {}

  /// Each pair of faces once. `watch` may be null. Errors: those of corrupt leaves.
  [[nodiscard]] Errc run(const LeafPair& leaves, const TriangleWatch* watch);

  /// Whether the visitor or the watch asked to stop.
  [[nodiscard]] bool stopped() const noexcept { return stopped_; }

 private:
  [[nodiscard]] Errc read_first(NodeRef leaf) noexcept;
  [[nodiscard]] Errc read_second(NodeRef leaf) noexcept;
  [[nodiscard]] bool was_found(std::uint64_t found, std::uint32_t j) const noexcept;

  static constexpr NodeRef kNone{0xffffffffu, 0xffffffffu};

  const Tree& first_;
  const Tree& second_;
  const RelativePose& pose_;
  PairVisitor visitor_;
  bool stopped_ = false;
  NodeRef first_read_ = kNone;  // the leaf that first_batch_ holds
  NodeRef second_read_ = kNone;
  TriangleBatch first_batch_;
  TriangleBatch second_batch_;
  std::array<Box<double>, kMaxLeafTriangles> first_bounds_;
  std::array<Triangle, kMaxLeafTriangles> moved_;  // the second leaf in the first tree's space
  std::array<Box<double>, kMaxLeafTriangles> moved_bounds_;
};

}  // namespace boxtree
