// SPDX-License-Identifier: MIT
// What box and sphere queries share: walk the boxes that overlap, report each face that touches.
#pragma once

#include <boxtree/runtime/query/traversal.h>

namespace boxtree {

/// The query of traverse_overlap for a shape.
/// shape.overlaps(const Box<S>&) -> bool: monotone, as traverse_overlap asks.
/// Shape::Visitor: what is called with each face, FaceVisitor or another one; whether to go on.
/// shape.touches(const Triangle&) -> bool: the exact test, in tree space.
template <class Shape>
struct FaceWalk {
  const Tree& tree;
  const Shape& shape;
  typename Shape::Visitor visitor;
  Errc error = Errc::kOk;
  bool stopped = false;
  TriangleBatch batch;

  template <class S>
  [[nodiscard]] bool overlaps(const Box<S>& box) const noexcept {
    return shape.overlaps(box);
  }

  [[nodiscard]] bool leaf(NodeRef ref) {
    error = tree.leaves().read(ref.first, ref.second, batch);
    if (error != Errc::kOk) return false;
    std::uint32_t reported = kNoFaceId;
    for (std::uint32_t i = 0; i < batch.count && !stopped; ++i) {
      if (batch.face[i] == reported) continue;  // the other half of the quad has touched already
      const Triangle triangle = batch.triangle(i);
      if (!shape.overlaps(bounds_of(triangle)) || !shape.touches(triangle)) continue;
      reported = batch.face[i];
      stopped = !report_face(tree, reported, visitor);
    }
    return !stopped;
  }
};

}  // namespace boxtree
