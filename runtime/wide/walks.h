// SPDX-License-Identifier: MIT
// How a query walks a tree: any codec by the templates of query/traversal.h, the wide ones by walks
// of their own, eight children at a time. Overloads choose; both give the same answers.
#pragma once

#include <boxtree/format/codec_wide.h>
#include <boxtree/runtime/query/face_visit.h>
#include <boxtree/runtime/query/point_query.h>
#include <boxtree/runtime/query/ray_query.h>
#include <boxtree/runtime/query/shape_query.h>
#include <boxtree/runtime/query/traversal.h>

namespace boxtree {

/// Visits what can matter to the query, from near to far. Returns kNodeCorrupt or kDepthExceeded
/// for corrupt nodes; the query holds the errors of leaves.
template <Codec C, class Query>
Errc walk_nearest(const Tree& tree, const C& codec, Query& query) {
  return traverse_nearest(tree, codec, query);
}
Errc walk_nearest(const Tree& tree, const WideCodec<Wide8Node>& codec, RayQuery& query);
Errc walk_nearest(const Tree& tree, const WideCodec<Wide4Node>& codec, RayQuery& query);
Errc walk_nearest(const Tree& tree, const WideCodec<Wide8Node>& codec, PointQuery& query);
Errc walk_nearest(const Tree& tree, const WideCodec<Wide4Node>& codec, PointQuery& query);

/// Visits the faces that touch the shape; errors likewise.
template <Codec C, class Shape>
Errc walk_overlap(const Tree& tree, const C& codec, FaceWalk<Shape>& walk) {
  return traverse_overlap(tree, codec, walk);
}
Errc walk_overlap(const Tree& tree, const WideCodec<Wide8Node>& codec, FaceWalk<BoxQuery>& walk);
Errc walk_overlap(const Tree& tree, const WideCodec<Wide4Node>& codec, FaceWalk<BoxQuery>& walk);
Errc walk_overlap(const Tree& tree, const WideCodec<Wide8Node>& codec, FaceWalk<SphereQuery>& walk);
Errc walk_overlap(const Tree& tree, const WideCodec<Wide4Node>& codec, FaceWalk<SphereQuery>& walk);

/// Visits each face once of which some triangle touches the shape.
template <class Shape>
Result<Visit> visit_faces(const Tree& tree, const Shape& shape, FaceVisitor visitor) {
  FaceWalk<Shape> walk{tree, shape, visitor, Errc::kOk, false, {}};
  const Errc walked =
      with_codec(tree, [&](const auto& codec) { return walk_overlap(tree, codec, walk); });
  if (walked != Errc::kOk) return walked;
  if (walk.error != Errc::kOk) return walk.error;
  return walk.stopped ? Visit::kStopped : Visit::kComplete;
}

}  // namespace boxtree
