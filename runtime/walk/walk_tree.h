// SPDX-License-Identifier: MIT
// How a query walks a tree: by vectors, eight children at a time, for the wide codecs if the build
// has vectors; by the templates of traversal.h otherwise. All give the same answers.
#pragma once

#include "format/codec_wide.h"
#include "runtime/tree/bound_tree.h"
#include "runtime/walk/codec_walks.h"
#include "runtime/walk/erased_codec.h"
#include "runtime/walk/face_visit.h"
#include "runtime/walk/traversal.h"
#include "runtime/walk/work.h"

namespace boxtree {

/// Whether trees of other codecs can be, with boxtree::paper.
inline constexpr bool kHasOtherCodecs = BOXTREE_HAS_PLAIN_F32 || BOXTREE_HAS_PLAIN_F16 ||
                                        BOXTREE_HAS_PACKED_F32 || BOXTREE_HAS_PACKED_F16 ||
                                        BOXTREE_HAS_PACKED_F64 || BOXTREE_HAS_DEDUP;
static_assert(kCodecs.size() == 8, "each is named in one of these two");

/// Whether the nodes of a tree are those of a wide codec.
[[nodiscard]] inline bool has_wide_nodes(const BoundTree& tree) noexcept {
  return kHasWideCodecs && is_wide(tree.codec_functions().id);
}

/// Calls `visitor` with the codec of a tree that has wide nodes. In builds without other codecs the
/// tree may also have no nodes; it then gets one of the wide codecs.
template <class Answer, class Visitor>
Answer with_wide_codec([[maybe_unused]] const BoundTree& tree,
                       [[maybe_unused]] const Visitor& visitor) {
#if BOXTREE_HAS_WIDE8
  if (tree.codec_functions().id == CodecId::kWide8) {
    return visitor(tree.nodes().as<WideCodec<Wide8Node>>());
  }
#endif
#if BOXTREE_HAS_WIDE4
  if (tree.codec_functions().id == CodecId::kWide4) {
    return visitor(tree.nodes().as<WideCodec<Wide4Node>>());
  }
#endif
#if BOXTREE_HAS_WIDE4
  if constexpr (!kHasOtherCodecs) return visitor(WideCodec<Wide4Node>());
#elif BOXTREE_HAS_WIDE8
  if constexpr (!kHasOtherCodecs) return visitor(WideCodec<Wide8Node>());
#endif
  return Errc::kInternal;
}

// Queries that the wide codecs walk by vectors have a function in query/*_wide.cpp:
//   Errc walk_wide(const BoundTree& tree, QUERY& query);   Precondition: the tree has wide nodes.

/// The walk of a query over a tree of any codec. `plain`: the walk of traversal.h for one codec.
template <class Query, class Plain>
Errc walk_tree(const BoundTree& tree, Query& query, const Plain& plain) {
  if constexpr (kWalksTreesByVectors) {
    if (has_wide_nodes(tree)) return walk_wide(tree, query);
  }
  if constexpr (kHasCodecWalks<Query> && !kHasOtherCodecs && !kWalksByVectors) {
    return with_wide_codec<Errc>(tree, plain);
  } else if constexpr (kHasCodecWalks<Query>) {
    if constexpr (!kWalksByVectors) {
      if (has_wide_nodes(tree)) return with_wide_codec<Errc>(tree, plain);
    }
    if (const CodecWalks* own = tree.codec_functions().walks) {
      return (own->*kWalkOf<Query>)(tree, query);
    }
    return plain(ErasedCodec{&tree});
  } else {
    return plain(ErasedCodec{&tree});
  }
}

/// Visits what can matter to the query, from near to far. Returns kNodeCorrupt or kDepthExceeded
/// for corrupt nodes; the query holds the errors of leaves.
template <class Query>
Errc walk_nearest(const BoundTree& tree, Query& query) {
  return walk_tree(tree, query,
                   [&](const auto& codec) { return traverse_nearest(tree, codec, query); });
}

/// Visits the faces that touch the shape; errors likewise.
template <class Shape>
Errc walk_overlap(const BoundTree& tree, FaceWalk<Shape>& walk) {
  return walk_tree(tree, walk,
                   [&](const auto& codec) { return traverse_overlap(tree, codec, walk); });
}

/// Visits each face once of which some triangle touches the shape.
template <class Shape>
Result<Visit> visit_faces(const BoundTree& tree, const Shape& shape,
                          typename Shape::Visitor visitor, QueryWork& work) {
  WalkBound nodes(tree.node_count(), &work);
  FaceWalk<Shape> walk{{tree, visitor}, shape, nodes};
  return outcome_of(walk_overlap(tree, walk), walk);
}

}  // namespace boxtree
