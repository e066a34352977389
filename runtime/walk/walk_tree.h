// SPDX-License-Identifier: MIT
// How a query walks a tree: any codec by the templates of traversal.h, the wide ones by walks
// of their own, eight children at a time, where there are vectors. Both give the same answers.
#pragma once

#include "format/codec_wide.h"
#include "runtime/tree/bound_tree.h"
#include "runtime/walk/erased_codec.h"
#include "runtime/walk/face_visit.h"
#include "runtime/walk/traversal.h"
#include "runtime/walk/work.h"

namespace boxtree {

/// Whether trees of a wide codec can be bound.
inline constexpr bool kHasWideCodecs = []<CodecId... Ids>(CodecList<Ids...>) {
  return (is_wide(Ids) || ...);
}
(BuiltCodecs());

/// Whether trees of a codec are walked by vectors.
template <Codec C>
inline constexpr bool kIsWalkedByVectors = false;
template <class Node>
inline constexpr bool kIsWalkedByVectors<WideCodec<Node>> = kWalksByVectors;

/// Calls `visitor` with the codec of a tree, one of the wide ones.
template <class Answer, class Visitor>
Answer with_wide_codec(const BoundTree& tree, const Visitor& visitor) {
  return with_codec(tree, [&]<class C>([[maybe_unused]] const C& codec) -> Answer {
    if constexpr (kIsWalkedByVectors<C>) {
      return visitor(codec);
    } else {
      return Errc::kInternal;
    }
  });
}

// Queries that the wide codecs walk by vectors have a function of their own, in query/*_wide.cpp:
//   Errc walk_wide(const BoundTree& tree, QUERY& query);   Precondition: the codec of `tree` is a
//   wide one.

/// Visits what can matter to the query, from near to far. Returns kNodeCorrupt or kDepthExceeded
/// for corrupt nodes; the query holds the errors of leaves.
template <Codec C, class Query>
Errc walk_nearest(const BoundTree& tree, const C& codec, Query& query) {
  if constexpr (kIsWalkedByVectors<C>) {
    return walk_wide(tree, query);
  } else {
    return traverse_nearest(tree, codec, query);
  }
}

/// Visits the faces that touch the shape; errors likewise.
template <Codec C, class Shape>
Errc walk_overlap(const BoundTree& tree, const C& codec, FaceWalk<Shape>& walk) {
  if constexpr (kIsWalkedByVectors<C>) {
    return walk_wide(tree, walk);
  } else {
    return traverse_overlap(tree, codec, walk);
  }
}

/// Visits each face once of which some triangle touches the shape.
template <class Shape>
Result<Visit> visit_faces(const BoundTree& tree, const Shape& shape,
                          typename Shape::Visitor visitor, QueryWork& work) {
  WalkBound nodes(tree.record().node_count, &work);
  FaceWalk<Shape> walk{tree, shape, visitor, nodes};
  const Errc walked =
      with_codec(tree, [&](const auto& codec) { return walk_overlap(tree, codec, walk); });
  return outcome_of(walked, walk);
}

/// The same without a walk of its own for each codec: by vectors, and one walk for all others.
template <class Shape>
Result<Visit> visit_faces_compactly(const BoundTree& tree, const Shape& shape,
                                    typename Shape::Visitor visitor, QueryWork& work) {
  WalkBound nodes(tree.record().node_count, &work);
  FaceWalk<Shape> walk{tree, shape, visitor, nodes};
  if constexpr (kWalksByVectors && kHasWideCodecs) {
    if (is_wide(tree.codec())) return outcome_of(walk_wide(tree, walk), walk);
  }
  return outcome_of(traverse_overlap(tree, ErasedCodec{&tree}, walk), walk);
}

}  // namespace boxtree
