// SPDX-License-Identifier: MIT
// What box and sphere queries share: walk the boxes that overlap, report each face that touches.
#pragma once

#include "runtime/tree/bound_tree.h"
#include "runtime/walk/traversal.h"
#include "runtime/walk/work.h"

namespace boxtree {

/// Reports faces and their copies to a visitor, which returns whether to go on.
template <class Visitor>
struct FaceReport {
  const BoundTree& tree;
  Visitor visitor;
  Errc error = Errc::kOk;
  bool stopped = false;
  // In valid files each copy is reported once; in corrupt ones many faces may have the same copies.
  std::uint32_t copies_left = tree.duplicate_count();

  /// `refs`: of the tree; kept from one face to the next. Returns whether to go on.
  [[nodiscard]] [[gnu::always_inline]] bool report(std::uint32_t face, LeafFaceRefs& refs) {
    stopped = !visitor(refs(face));
    return !stopped && (!tree.has_duplicates() || report_copies(face));
  }

 private:
  [[nodiscard]] bool report_copies(std::uint32_t face) {
    const FaceWithCopies faces(tree, face);
    if (faces.count() - 1 > copies_left) {
      error = Errc::kNodeCorrupt;
      return false;
    }
    copies_left -= faces.count() - 1;
    for (std::uint32_t i = 1; i < faces.count() && !stopped; ++i) stopped = !visitor(faces.face(i));
    return !stopped;
  }
};

/// The query of traverse_overlap for a shape.
/// shape.overlaps(const Box<S>&) -> bool: monotone, as traverse_overlap requires.
/// Shape::Visitor: called with each face, FaceVisitor or another type; returns whether to go on.
/// shape.touches(const Triangle&) -> bool: the exact test, in tree space.
template <class Shape>
struct FaceWalk : FaceReport<typename Shape::Visitor> {
  const Shape& shape;
  WalkBound& nodes;
  LeafFaceRefs refs{this->tree};
  TriangleBatch batch;

  template <class S>
  [[nodiscard]] bool overlaps(const Box<S>& box) const noexcept {
    return shape.overlaps(box);
  }

  [[nodiscard]] bool leaf(NodeRef ref) {
    // Not by read_leaf(), whose 8 KB of stack frustums in scenes do not have.
    this->error = this->tree.leaves().read(ref.first, ref.second, batch);
    if (this->error != Errc::kOk) return false;
    std::uint32_t reported = kNoFaceId;
    for (std::uint32_t i = 0; i < batch.count; ++i) {
      if (batch.face[i] == reported) continue;  // the other half of the quad has touched already
      const Triangle triangle = batch.triangle(i);
      if (!shape.overlaps(bounds_of(triangle)) || !shape.touches(triangle)) continue;
      reported = batch.face[i];
      if (!report(reported)) return false;
    }
    return true;
  }

  /// See FaceReport.
  [[nodiscard]] [[gnu::always_inline]] bool report(std::uint32_t face) {
    return FaceReport<typename Shape::Visitor>::report(face, refs);
  }
};

}  // namespace boxtree
